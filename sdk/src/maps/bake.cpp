#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "job/program.hpp"
#include "relievo/maps.hpp"

namespace relievo {

namespace {

/// The twin of the block `Bake` in shaders/lib/bake.glsl.
struct BakeBlock {
  std::array<std::int32_t, 4> size;  // width, height, channels, level
};

constexpr int bake_block_binding = 1, bake_texels_binding = 2;
constexpr std::uint32_t bake_group = 8;

std::map<std::string, double> values_of(const std::map<std::string, double>& values, const MapDescriptor& map) {
  std::map<std::string, double> own;
  for (const auto& [name, value] : values) {
    bool of_map = name.starts_with(map.name + ".");
    for (const std::string& input : map.inputs) of_map = of_map || name.starts_with(input + ".");
    if (of_map) own[name] = value;
  }
  return own;
}

Job bake_job(const PreparedProgram& prepared, const MapDescriptor& descriptor, const MapSet& maps, const MapData& output) {
  Job job;
  job.name = "bake " + descriptor.name;
  job.programs.push_back(prepared.program);
  Dispatch dispatch;
  bind_maps(prepared.composed, maps, job, dispatch.resources);
  bind_parameters(prepared.composed, job, dispatch.resources);
  BakeBlock block{{output.width, output.height, output.channels, 0}};
  bind_buffer(0, bake_block_binding, make_buffer("Bake", &block, sizeof(block)), job, dispatch.resources);
  std::size_t texels = static_cast<std::size_t>(output.width) * static_cast<std::size_t>(output.height);
  Buffer result{"MapTexels", texels * static_cast<std::size_t>(output.channels) * sizeof(float), {}};
  int index = bind_buffer(0, bake_texels_binding, std::move(result), job, dispatch.resources);
  dispatch.groups = {(static_cast<std::uint32_t>(output.width) + bake_group - 1) / bake_group,
                     (static_cast<std::uint32_t>(output.height) + bake_group - 1) / bake_group, 1};
  job.commands.emplace_back(std::move(dispatch));
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
  Result<ComposedProgram> composed = compose_bake(registry, name, height.address, values_of(values, descriptor));
  if (!composed) return tl::unexpected(composed.error());
  Result<PreparedProgram> prepared = prepare_composed(std::move(*composed), backend.info().shader_target);
  if (!prepared) return tl::unexpected(prepared.error());

  MapData output{descriptor.name, height.width, height.height, descriptor.channels, {}, height.address};
  Result<JobResult> result = backend.execute(bake_job(*prepared, descriptor, maps, output));
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  const std::vector<std::byte>& bytes = result->read_backs.at(0);
  output.texels.resize(bytes.size() / sizeof(float));
  std::memcpy(output.texels.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; i < output.texels.size(); ++i) {
    if (std::isfinite(output.texels[i])) continue;
    return fail(ErrorCode::backend, "maps.non-finite",
                fmt::format("map '{}' has the value {} at element {}; expected a finite number", name, output.texels[i], i));
  }
  maps[descriptor.name] = std::move(output);
  return {};
}

}  // namespace relievo
