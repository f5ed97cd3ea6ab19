#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "job/program.hpp"
#include "relievo/maps.hpp"

namespace relievo {

namespace {

/// The twin of the block `Bake` in shaders/lib/bake.glsl.
struct BakeBlock {
  std::array<std::int32_t, 4> size;    // width, height, channels, level
  std::array<std::int32_t, 4> source;  // of the level below: width, height, offset; offset of this level, in texels
  std::array<std::int32_t, 4> layers;  // how many, pass, floats in a buffer
};

constexpr int bake_block_binding = 1, bake_texels_binding = 2;  // and those after it
constexpr std::uint32_t bake_group = 8;

/// The values of the map's own parameters. A technique may have the map's name, and parameters of its own.
void add_values_of(const MapDescriptor& map, const std::map<std::string, double>& values,
                   std::map<std::string, double>& own) {
  for (const Parameter& parameter : map.parameters) {
    const auto found = values.find(fmt::format("{}.{}", map.name, parameter.name));
    if (found != values.end()) own.insert(*found);
  }
}

std::map<std::string, double> values_for_bake(const Registry& registry, const MapDescriptor& map,
                                              const std::map<std::string, double>& values) {
  std::map<std::string, double> own;
  add_values_of(map, values, own);
  for (const std::string& input : map.inputs) add_values_of(registry.maps.find(input)->second, values, own);
  return own;
}

/// The floats of a map over storage buffers that a backend takes.
struct Partition {
  std::size_t floats = 0, in_buffer = 0;

  std::size_t buffers() const { return (floats + in_buffer - 1) / in_buffer; }
  std::size_t in(std::size_t buffer) const { return std::min(in_buffer, floats - buffer * in_buffer); }
};

Result<Partition> partition(const MapData& output, const BackendInfo& backend) {
  Partition parts;
  parts.floats = parts.in_buffer = texel_count(output) * static_cast<std::size_t>(output.channels);
  if (backend.max_storage_buffer >= sizeof(float))
    parts.in_buffer = std::min(parts.in_buffer, backend.max_storage_buffer / sizeof(float));
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();  // shaders count in int
  if (parts.buffers() <= most_bake_buffers && parts.floats <= most) return parts;
  return fail(ErrorCode::unsupported, "maps.too-large",
              fmt::format("map '{}' of {}x{} texels takes {} bytes; expected at most {} on backend '{}', which has "
                          "storage buffers of {} bytes",
                          output.name, output.width, output.height, parts.floats * sizeof(float),
                          std::min(most, parts.in_buffer * most_bake_buffers) * sizeof(float), backend.name,
                          backend.max_storage_buffer));
}

BakeBlock bake_block(const MapData& output, int level, int pass, const Partition& parts) {
  MapLevel here = map_level(output, level), below = map_level(output, std::max(0, level - 1));
  return {{here.width, here.height, output.channels, level},
          {below.width, below.height, static_cast<std::int32_t>(below.offset), static_cast<std::int32_t>(here.offset)},
          {output.depth, pass, static_cast<std::int32_t>(parts.in_buffer), 0}};
}

/// One dispatch a level and pass: a command sees what earlier ones wrote.
Job bake_job(const PreparedProgram& prepared, const MapDescriptor& descriptor, const MapSet& maps,
             const MapData& output, const Partition& parts) {
  Job job;
  job.name = "bake " + descriptor.name;
  job.programs.push_back(prepared.program);
  std::vector<ResourceBinding> shared;
  bind_maps(prepared.composed, maps, job, shared);
  bind_parameters(prepared.composed, job, shared);
  for (std::size_t k = 0; k < parts.buffers(); ++k) {
    Buffer texels{k == 0 ? "MapTexels" : fmt::format("MapTexels{}", k), parts.in(k) * sizeof(float), {}};
    const int index = bind_buffer(0, bake_texels_binding + static_cast<int>(k), std::move(texels), job, shared);
    job.read_backs.push_back({ReadBack::Source::buffer, index, 0});
  }
  for (int k = 0; k < output.levels * descriptor.passes; ++k) {
    Dispatch dispatch;
    dispatch.resources = shared;
    BakeBlock block = bake_block(output, k / descriptor.passes, k % descriptor.passes, parts);
    bind_buffer(0, bake_block_binding, make_buffer("Bake", &block, sizeof(block)), job, dispatch.resources);
    keep_contract(prepared.program, dispatch.resources);
    auto groups = [](int extent) { return (static_cast<std::uint32_t>(extent) + bake_group - 1) / bake_group; };
    dispatch.groups = {groups(block.size[0]), groups(block.size[1]), static_cast<std::uint32_t>(output.depth)};
    job.commands.emplace_back(std::move(dispatch));
  }
  return job;
}

/// Each part is freed when it is copied: maps may be large.
void join(std::vector<std::vector<std::byte>> parts, std::vector<float>& texels) {
  for (std::vector<std::byte>& part : parts) {
    const std::size_t start = texels.size();
    texels.resize(start + part.size() / sizeof(float));
    std::memcpy(texels.data() + start, part.data(), part.size());
    part = {};
  }
}

}  // namespace

Status bake_map(Backend& backend, const Registry& registry, std::string_view name, MapSet& maps,
                const std::map<std::string, double>& values, std::vector<std::string>* messages) {
  if (maps.contains(name)) return {};
  Result<const MapDescriptor*> found = registry.map(name);
  if (!found) return tl::unexpected(found.error());
  const MapDescriptor& descriptor = **found;
  for (const std::string& input : descriptor.inputs) {
    if (Status status = bake_map(backend, registry, input, maps, values, messages); !status) return status;
  }
  const MapData& height = maps.find("height")->second;
  const std::map<std::string, double> own = values_for_bake(registry, descriptor, values);
  // Composing checks the values, of which the shape depends.
  Result<ComposedProgram> composed = compose_bake(registry, name, height.address, own);
  if (!composed) return tl::unexpected(composed.error());
  MapData output = map_shape(descriptor, height.width, height.height, height.address, own);
  const int bits = std::exchange(output.bits, 32);
  const Result<Partition> parts = partition(output, backend.info());
  if (!parts) return tl::unexpected(parts.error());
  if (parts->buffers() > 1)
    composed = compose_bake(registry, name, height.address, own, static_cast<int>(parts->buffers()));
  Result<PreparedProgram> prepared = prepare_composed(std::move(*composed), backend.info().shader_target);
  if (!prepared) return tl::unexpected(prepared.error());
  Result<JobResult> result = backend.execute(bake_job(*prepared, descriptor, maps, output, *parts));
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  output.texels.reserve(parts->floats);
  join(std::move(result->read_backs), output.texels);
  for (std::size_t i = 0; i < output.texels.size(); ++i) {
    if (std::isfinite(output.texels[i])) continue;
    return fail(
        ErrorCode::backend, "maps.non-finite",
        fmt::format("map '{}' has the value {} at element {}; expected a finite number", name, output.texels[i], i));
  }
  if (Status status = quantise(output, bits, descriptor.rounding); !status) return status;
  maps[descriptor.name] = std::move(output);
  return {};
}

}  // namespace relievo
