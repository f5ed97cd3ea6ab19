#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "job/validate.hpp"

namespace relievo {

namespace {

// What every Vulkan and OpenGL implementation offers.
constexpr std::uint32_t max_groups = 65535;
constexpr int max_location = 15, max_stride = 2048;
constexpr std::size_t max_color_targets = 8;

template <class T>
const T& at(const std::vector<T>& list, int index) {
  return list[static_cast<std::size_t>(index)];
}

bool is_buffer(ResourceKind kind) {
  return kind == ResourceKind::uniform_buffer || kind == ResourceKind::storage_buffer;
}

void check_resource(Check& check, const Job& job, const BindingSlot& slot, int resource) {
  if (is_buffer(slot.kind)) {
    check.require(in_range(resource, job.buffers), "job.index", "slot \"{}\" is bound to buffer {}, the job has {}",
                  slot.name, resource, job.buffers.size());
    return;
  }
  if (!check.require(in_range(resource, job.textures), "job.index",
                     "slot \"{}\" is bound to texture {}, the job has {}", slot.name, resource, job.textures.size())) {
    return;
  }
  const Texture& texture = at(job.textures, resource);
  if (slot.kind == ResourceKind::storage_texture) {
    check.require(channel_count(texture.format) != 3 && texture.format != Format::d32_float, "job.format",
                  "slot \"{}\" is bound to texture \"{}\" of format {}, which is no storage format", slot.name,
                  texture.name, to_string(texture.format));
  } else {
    const bool is_nearest =
        texture.sampler.min_mag == TexelFilter::nearest && texture.sampler.mip == TexelFilter::nearest;
    check.require(!is_integer(texture.format) || is_nearest, "job.format",
                  "texture \"{}\" of format {} has a linear filter, expected nearest", texture.name,
                  to_string(texture.format));
  }
}

void check_resources(Check& check, const Job& job, int program, const std::vector<ResourceBinding>& resources) {
  std::map<std::pair<int, int>, int> bound;
  for (const ResourceBinding& binding : resources) {
    check.require(bound.emplace(std::pair(binding.set, binding.binding), binding.resource).second, "job.binding",
                  "set {} binding {} is bound twice", binding.set, binding.binding);
  }
  for (const BindingSlot& slot : at(job.programs, program).bindings) {
    const auto found = bound.find({slot.set, slot.binding});
    if (!check.require(found != bound.end(), "job.binding", "slot \"{}\" (set {} binding {}) is not bound", slot.name,
                       slot.set, slot.binding)) {
      return;
    }
    check_resource(check, job, slot, found->second);
    bound.erase(found);
  }
  if (bound.empty()) return;
  const auto [set, binding] = bound.begin()->first;
  check.require(false, "job.binding", "binds set {} binding {}, which the program does not have", set, binding);
}

void check_attributes(Check& check, const Draw& draw) {
  std::set<int> locations;
  check.require(draw.vertex_stride >= 1 && draw.vertex_stride <= max_stride, "job.vertex",
                "the vertex stride is {} bytes, expected 1..{}", draw.vertex_stride, max_stride);
  for (const VertexAttribute& attribute : draw.attributes) {
    const bool is_32_bit = bytes_per_texel(attribute.format) == 4 * channel_count(attribute.format);
    check.require(is_32_bit && attribute.format != Format::d32_float, "job.vertex",
                  "vertex attribute {} has format {}, expected a 32-bit one", attribute.location,
                  to_string(attribute.format));
    check.require(attribute.location >= 0 && attribute.location <= max_location, "job.vertex",
                  "a vertex attribute has location {}, expected 0..{}", attribute.location, max_location);
    check.require(locations.insert(attribute.location).second, "job.vertex", "two vertex attributes have location {}",
                  attribute.location);
    check.require(attribute.offset >= 0 && attribute.offset <= draw.vertex_stride - bytes_per_texel(attribute.format),
                  "job.vertex", "vertex attribute {} at offset {} does not fit in the stride of {}", attribute.location,
                  attribute.offset, draw.vertex_stride);
  }
}

std::uint32_t largest_index(const std::vector<std::byte>& data, std::uint32_t count) {
  std::uint32_t largest = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t index = 0;
    std::memcpy(&index, data.data() + std::size_t{4} * i, sizeof index);
    largest = std::max(largest, index);
  }
  return largest;
}

/// Checks the index buffer and returns how many vertices the draw reads. Indices that an earlier command writes are
/// not known here; backends ask the driver for bounds checks.
std::size_t check_indices(Check& check, const Job& job, const Draw& draw) {
  if (draw.index_buffer == -1) return draw.count;
  if (!check.require(in_range(draw.index_buffer, job.buffers), "job.index",
                     "draws with index buffer {}, the job has {}", draw.index_buffer, job.buffers.size())) {
    return 0;
  }
  const Buffer& indices = at(job.buffers, draw.index_buffer);
  if (!check.require(std::size_t{4} * draw.count <= indices.size, "job.size",
                     "draws {} indices, buffer \"{}\" holds {}", draw.count, indices.name, indices.size / 4)) {
    return 0;
  }
  return indices.data.empty() ? 1 : std::size_t{1} + largest_index(indices.data, draw.count);
}

void check_vertices(Check& check, const Job& job, const Draw& draw, std::size_t vertices) {
  if (draw.attributes.empty()) return;
  check_attributes(check, draw);
  if (!check.require(in_range(draw.vertex_buffer, job.buffers), "job.index", "draws vertex buffer {}, the job has {}",
                     draw.vertex_buffer, job.buffers.size()) ||
      !check.ok()) {
    return;
  }
  const Buffer& buffer = at(job.buffers, draw.vertex_buffer);
  const std::size_t held = buffer.size / static_cast<std::size_t>(draw.vertex_stride);
  check.require(vertices <= held, "job.size", "reads {} vertices, buffer \"{}\" holds {}", vertices, buffer.name, held);
}

bool is_sampled_or_stored(const Job& job, const Draw& draw, int texture) {
  const auto& slots = at(job.programs, draw.program).bindings;
  return std::any_of(draw.resources.begin(), draw.resources.end(), [&](const ResourceBinding& binding) {
    const auto slot = std::find_if(slots.begin(), slots.end(), [&](const BindingSlot& s) {
      return s.set == binding.set && s.binding == binding.binding;
    });
    return slot != slots.end() && !is_buffer(slot->kind) && binding.resource == texture;
  });
}

void check_target(Check& check, const Job& job, const Draw& draw, int index, bool is_depth) {
  if (!check.require(in_range(index, job.textures), "job.index", "draws to texture {}, the job has {}", index,
                     job.textures.size())) {
    return;
  }
  const Texture& target = at(job.textures, index);
  const int first = draw.color_targets.empty() ? draw.depth_target : draw.color_targets.front();
  const Texture& reference = in_range(first, job.textures) ? at(job.textures, first) : target;
  const char* expected = is_depth ? "d32_float" : "a color format of 1, 2 or 4 channels";
  const bool fits = is_depth ? target.format == Format::d32_float
                             : target.format != Format::d32_float && channel_count(target.format) != 3;
  check.require(fits, "job.target", "target \"{}\" has format {}, expected {}", target.name, to_string(target.format),
                expected);
  check.require(!target.is_3d && !target.is_array && target.depth == 1, "job.target",
                "target \"{}\" is a 3D texture, expected a 2D one", target.name);
  check.require(target.width == reference.width && target.height == reference.height, "job.target",
                "target \"{}\" is {}x{} texels, expected {}x{} as \"{}\"", target.name, target.width, target.height,
                reference.width, reference.height, reference.name);
  check.require(!is_sampled_or_stored(job, draw, index), "job.target", "texture \"{}\" is read and drawn to",
                target.name);
}

void check_targets(Check& check, const Job& job, const Draw& draw) {
  const std::set<int> distinct(draw.color_targets.begin(), draw.color_targets.end());
  check.require(distinct.size() == draw.color_targets.size(), "job.target", "draws to one texture twice");
  check.require(draw.color_targets.size() <= max_color_targets, "job.target", "has {} color targets, expected up to {}",
                draw.color_targets.size(), max_color_targets);
  check.require(!draw.color_targets.empty() || draw.depth_target != -1, "job.target", "has no target");
  for (const int index : draw.color_targets) check_target(check, job, draw, index, false);
  if (draw.depth_target != -1) check_target(check, job, draw, draw.depth_target, true);
}

void check_clears(Check& check, const Draw& draw) {
  const float depth = draw.clear_depth.value_or(0);
  check.require(depth >= 0 && depth <= 1, "job.clear", "clears depth to {}, expected 0..1", depth);
  const auto color = draw.clear_color.value_or(std::array<float, 4>{});
  check.require(std::all_of(color.begin(), color.end(), [](float value) { return std::isfinite(value); }), "job.clear",
                "clears color to ({}, {}, {}, {}), expected finite values", color[0], color[1], color[2], color[3]);
}

/// The program exists and is of the kind that the command runs.
bool check_program_index(Check& check, const Job& job, int program, bool compute) {
  if (!check.require(in_range(program, job.programs), "job.index", "runs program {}, the job has {}", program,
                     job.programs.size())) {
    return false;
  }
  return check.require(is_compute(at(job.programs, program)) == compute, "job.program", "expected a {} program",
                       compute ? "compute" : "graphics");
}

}  // namespace

void check_command(Check& check, const Job& job, const Dispatch& dispatch) {
  if (!check_program_index(check, job, dispatch.program, true)) return;
  const auto& groups = dispatch.groups;
  check.require(std::all_of(groups.begin(), groups.end(), [](auto n) { return n >= 1 && n <= max_groups; }),
                "job.groups", "dispatches {}x{}x{} groups, expected 1..{} in each direction", groups[0], groups[1],
                groups[2], max_groups);
  check_resources(check, job, dispatch.program, dispatch.resources);
}

void check_command(Check& check, const Job& job, const Draw& draw) {
  if (!check_program_index(check, job, draw.program, false)) return;
  check_resources(check, job, draw.program, draw.resources);
  check.require(draw.count >= 3 && draw.count % 3 == 0, "job.count",
                "draws {} vertices, expected a positive multiple of 3", draw.count);
  check.require(draw.instances >= 1, "job.count", "draws 0 instances, expected at least 1");
  check_vertices(check, job, draw, check_indices(check, job, draw));
  check_targets(check, job, draw);
  check_clears(check, draw);
}

}  // namespace relievo
