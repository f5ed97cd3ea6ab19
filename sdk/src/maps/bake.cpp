#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "job/program.hpp"
#include "relievo/maps.hpp"

namespace relievo {

namespace {

/// The twin of the block `Bake` in shaders/lib/bake.glsl.
struct BakeBlock {
  std::array<std::int32_t, 4> size;    // width, height, channels, level
  std::array<std::int32_t, 4> source;  // of the level below: width, height, offset; offset of this level, in texels
  std::array<std::int32_t, 4> layers;  // how many, pass
};

constexpr int bake_block_binding = 1, bake_texels_binding = 2;
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

BakeBlock bake_block(const MapData& output, int level, int pass) {
  MapLevel here = map_level(output, level), below = map_level(output, std::max(0, level - 1));
  return {{here.width, here.height, output.channels, level},
          {below.width, below.height, static_cast<std::int32_t>(below.offset), static_cast<std::int32_t>(here.offset)},
          {output.depth, pass, 0, 0}};
}

/// One dispatch a level and pass: a command sees what earlier ones wrote.
Job bake_job(const PreparedProgram& prepared, const MapDescriptor& descriptor, const MapSet& maps,
             const MapData& output) {
  Job job;
  job.name = "bake " + descriptor.name;
  job.programs.push_back(prepared.program);
  std::vector<ResourceBinding> shared;
  bind_maps(prepared.composed, maps, job, shared);
  bind_parameters(prepared.composed, job, shared);
  Buffer result{"MapTexels", texel_count(output) * static_cast<std::size_t>(output.channels) * sizeof(float), {}};
  int index = bind_buffer(0, bake_texels_binding, std::move(result), job, shared);
  for (int k = 0; k < output.levels * descriptor.passes; ++k) {
    Dispatch dispatch;
    dispatch.resources = shared;
    BakeBlock block = bake_block(output, k / descriptor.passes, k % descriptor.passes);
    bind_buffer(0, bake_block_binding, make_buffer("Bake", &block, sizeof(block)), job, dispatch.resources);
    keep_contract(prepared.program, dispatch.resources);
    auto groups = [](int extent) { return (static_cast<std::uint32_t>(extent) + bake_group - 1) / bake_group; };
    dispatch.groups = {groups(block.size[0]), groups(block.size[1]), static_cast<std::uint32_t>(output.depth)};
    job.commands.emplace_back(std::move(dispatch));
  }
  job.read_backs.push_back({ReadBack::Source::buffer, index, 0});
  return job;
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
  Result<ComposedProgram> composed = compose_bake(registry, name, height.address, own);
  if (!composed) return tl::unexpected(composed.error());
  Result<PreparedProgram> prepared = prepare_composed(std::move(*composed), backend.info().shader_target);
  if (!prepared) return tl::unexpected(prepared.error());

  MapData output = map_shape(descriptor, height.width, height.height, height.address, own);
  const int bits = std::exchange(output.bits, 32);
  Result<JobResult> result = backend.execute(bake_job(*prepared, descriptor, maps, output));
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  const std::vector<std::byte>& bytes = result->read_backs.at(0);
  output.texels.resize(bytes.size() / sizeof(float));
  std::memcpy(output.texels.data(), bytes.data(), bytes.size());
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
