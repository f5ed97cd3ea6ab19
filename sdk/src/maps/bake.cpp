#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "describe/origins.hpp"
#include "job/program.hpp"
#include "maps/bake_plan.hpp"
#include "maps/check_finite.hpp"
#include "maps/quantise.hpp"
#include "relievo/maps.hpp"

namespace relievo {

namespace {

/// The twin of the block `Bake` in shaders/lib/bake.glsl.
struct BakeBlock {
  std::array<std::int32_t, 4> size;    // width, height, channels, level
  std::array<std::int32_t, 4> source;  // of the level below: width, height, offset; offset of this level, in texels
  std::array<std::int32_t, 4> layers;  // how many, pass, floats in a buffer, the first of the dispatch
  std::array<std::int32_t, 4> slab;    // layers of the dispatch
};

constexpr int bake_block_binding = 1, bake_texels_binding = 2;  // and those after it
constexpr int bake_group = 8;

std::uint32_t groups_of(int count, int of) {
  return static_cast<std::uint32_t>((count + of - 1) / of);
}

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

/// Layers that one Job bakes.
struct BakeSlab {
  int first = 0, count = 1;
};

BakeBlock bake_block(const MapData& output, int level, int pass, const BakePlan& plan, const BakeSlab& slab) {
  MapLevel here = map_level(output, level), below = map_level(output, std::max(0, level - 1));
  return {{here.width, here.height, output.channels, level},
          {below.width, below.height, static_cast<std::int32_t>(below.offset), static_cast<std::int32_t>(here.offset)},
          {output.depth, pass, static_cast<std::int32_t>(plan.buffer_floats), slab.first},
          {slab.count}};
}

/// The buffers that the texels are written to, which are what comes back.
void bind_texels(const BakePlan& plan, const BakeSlab& slab, Job& job, std::vector<ResourceBinding>& resources) {
  for (std::size_t k = 0; k < plan.buffers(slab.count); ++k) {
    Buffer texels{
        k == 0 ? "MapTexels" : fmt::format("MapTexels{}", k), plan.in_buffer(k, slab.count) * sizeof(float), {}};
    const int index = bind_buffer(0, bake_texels_binding + static_cast<int>(k), std::move(texels), job, resources);
    job.read_backs.push_back({ReadBack::Source::buffer, index, 0});
  }
}

/// A program for each phase of a map's passes.
using PhasePrograms = std::vector<PreparedProgram>;

Result<PhasePrograms> prepare_phases(const Registry& registry, const MapDescriptor& map, AddressMode address,
                                     const std::map<std::string, double>& values, int buffers,
                                     std::string_view shader_target) {
  PhasePrograms programs;
  for (int phase = 0; phase < static_cast<int>(map.passes.size()); ++phase) {
    Result<ComposedProgram> composed = compose_bake(registry, map.name, address, values, {phase, buffers});
    if (!composed) return tl::unexpected(name_file_on_disk(composed.error(), registry));
    Result<PreparedProgram> prepared = prepare_composed(std::move(*composed), shader_target);
    if (!prepared) return tl::unexpected(name_file_on_disk(prepared.error(), registry));
    programs.push_back(std::move(*prepared));
  }
  return programs;
}

/// The phase of every pass.
std::vector<int> phases_of(const MapDescriptor& descriptor) {
  std::vector<int> phases;
  for (std::size_t phase = 0; phase < descriptor.passes.size(); ++phase)
    phases.insert(phases.end(), static_cast<std::size_t>(descriptor.passes[phase]), static_cast<int>(phase));
  return phases;
}

/// One dispatch a level and pass: a command sees what earlier ones wrote.
Result<Job> bake_job(const PhasePrograms& programs, const MapDescriptor& descriptor, const MapSet& maps,
                     const MapData& output, const BakePlan& plan, const BakeSlab& slab) {
  Job job;
  job.name = "bake " + descriptor.name;
  for (const PreparedProgram& prepared : programs) job.programs.push_back(prepared.program);
  std::vector<ResourceBinding> shared;
  if (Status status = bind_maps(programs.front().composed, maps, job, shared); !status)
    return tl::unexpected(status.error());
  bind_parameters(programs.front().composed, job, shared);
  bind_texels(plan, slab, job, shared);
  const std::vector<int> phases = phases_of(descriptor);
  const int passes = static_cast<int>(phases.size());
  for (int k = 0; k < output.levels * passes; ++k) {
    Dispatch dispatch;
    dispatch.program = phases[static_cast<std::size_t>(k % passes)];
    dispatch.resources = shared;
    BakeBlock block = bake_block(output, k / passes, k % passes, plan, slab);
    bind_buffer(0, bake_block_binding, make_buffer("Bake", &block, sizeof(block)), job, dispatch.resources);
    keep_contract(job.programs[static_cast<std::size_t>(dispatch.program)], dispatch.resources);
    dispatch.groups = {groups_of(block.size[0], bake_group), groups_of(block.size[1], bake_group),
                       groups_of(slab.count, descriptor.layers_at_once)};
    job.commands.emplace_back(std::move(dispatch));
  }
  keep_filters(job);
  return job;
}

/// The floats of a map as they come back, kept in the bits that it has in the end: maps may be large.
class BakedTexels {
 public:
  BakedTexels(const MapDescriptor& descriptor, int bits, std::size_t count)
      : descriptor_(descriptor), bits_(bits), values_(make_values(has_exact_channels() ? 32 : bits, count)) {}

  Status add(std::span<const std::byte> bytes) {
    std::vector<float> part;
    for (; !bytes.empty(); bytes = bytes.subspan(part.size() * sizeof(float))) {
      part.resize(std::min(part_values, bytes.size() / sizeof(float)));
      std::memcpy(part.data(), bytes.data(), part.size() * sizeof(float));
      Status finite = check_finite(descriptor_.name, part, added_, ErrorCode::backend, "maps.non-finite");
      if (!finite) return finite;
      if (Status status = append_rounded(descriptor_.name, part, descriptor_.rounding, values_); !status) return status;
      added_ += part.size();
    }
    return {};
  }

  /// Gives the map its texels. The values of exact channels decide together how many bits they need.
  Status move_to(MapData& map) {
    map.texels = std::move(values_);
    map.bits = map.texels.bits();
    return map.bits == bits_ ? Status() : quantise(map, bits_, descriptor_.rounding);
  }

 private:
  bool has_exact_channels() const {
    const auto& rounding = descriptor_.rounding;
    return std::find(rounding.begin(), rounding.end(), Rounding::exact) != rounding.end();
  }

  static constexpr std::size_t part_values = std::size_t{1} << 16;
  const MapDescriptor& descriptor_;
  const int bits_;
  MapTexels::Values values_;
  std::size_t added_ = 0;
};

Status bake_texels(Backend& backend, const PhasePrograms& programs, const MapDescriptor& descriptor, const MapSet& maps,
                   const MapData& output, const BakePlan& plan, BakedTexels& texels,
                   std::vector<std::string>* messages) {
  for (int first = 0; first < output.depth; first += plan.layers) {
    const BakeSlab slab{first, std::min(plan.layers, output.depth - first)};
    Status added;
    const auto add = [&](std::size_t, std::span<const std::byte> bytes) {
      if (added) added = texels.add(bytes);
    };
    Result<Job> job = bake_job(programs, descriptor, maps, output, plan, slab);
    if (!job) return tl::unexpected(job.error());
    Result<JobResult> result = backend.execute_once(std::move(*job), add);
    if (!result) return tl::unexpected(result.error());
    append_messages(*result, messages);
    if (!added) return added;
  }
  return {};
}

}  // namespace

Status bake_map(Backend& backend, const Registry& registry, std::string_view name, MapSet& maps,
                const std::map<std::string, double>& values, std::vector<std::string>* messages) {
  if (maps.contains(name)) return {};
  Result<const MapDescriptor*> found = registry.map(name);
  if (!found) return tl::unexpected(found.error());
  const MapDescriptor& descriptor = **found;
  if (Status status = check_height(maps); !status) return status;
  for (const std::string& input : descriptor.inputs) {
    if (Status status = bake_map(backend, registry, input, maps, values, messages); !status) return status;
  }
  const MapData& height = maps.find("height")->second;
  const std::map<std::string, double> own = values_for_bake(registry, descriptor, values);
  // Composing checks the values, of which the shape depends.
  if (auto checked = compose_bake(registry, name, height.address, own); !checked)
    return tl::unexpected(name_file_on_disk(checked.error(), registry));
  MapData output = map_shape(descriptor, height.width, height.height, height.address, own);
  const int bits = std::exchange(output.bits, 32);
  const Result<BakePlan> plan = plan_bake(output, descriptor, height, backend.info());
  if (!plan) return tl::unexpected(plan.error());
  const int buffers = static_cast<int>(plan->buffers(plan->layers));
  const Result<PhasePrograms> programs =
      prepare_phases(registry, descriptor, height.address, own, buffers, backend.info().shader_target);
  if (!programs) return tl::unexpected(programs.error());
  BakedTexels texels(descriptor, bits, static_cast<std::size_t>(output.depth) * plan->layer_floats);
  Status baked = bake_texels(backend, *programs, descriptor, maps, output, *plan, texels, messages);
  if (!baked) return baked;
  if (Status status = texels.move_to(output); !status) return status;
  maps[descriptor.name] = std::move(output);
  return {};
}

Status bake_required_maps(Backend& backend, const Registry& registry, std::string_view stage,
                          std::string_view technique, MapSet& maps, const std::map<std::string, double>& values,
                          std::vector<std::string>* messages) {
  Result<std::vector<std::string>> needed = required_maps(registry, stage, technique);
  if (!needed) return tl::unexpected(needed.error());
  for (const std::string& map : *needed) {
    if (Status status = bake_map(backend, registry, map, maps, values, messages); !status) return status;
  }
  return {};
}

}  // namespace relievo
