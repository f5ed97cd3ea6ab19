#include "job/program.hpp"

#include <fmt/format.h>

#include "compose/resolve.hpp"
#include "describe/origins.hpp"
#include "job/program_cache.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <variant>

namespace relievo {

Result<PreparedProgram> prepare_composed(ComposedProgram composed, std::string_view shader_target) {
  std::vector<Target> targets;
  if (shader_target != "spirv") {
    Result<Target> target = parse_target(shader_target);
    if (!target) return tl::unexpected(target.error());
    targets.push_back(*target);
  }
  if (std::optional<ShaderProgram> known = load_program(composed, shader_target))
    return PreparedProgram{std::move(composed), *std::move(known)};
  Result<CompiledProgram> compiled = compile(composed, targets);
  if (!compiled) return tl::unexpected(compiled.error());
  ShaderProgram program = to_shader_program(composed, *compiled);
  store_program(composed, shader_target, program);
  return PreparedProgram{std::move(composed), std::move(program)};
}

namespace {

std::string identity(const ComposedProgram& composed) {
  std::string text;
  for (const ComposedShader& shader : composed.shaders) text += shader.text;
  for (const ParameterSlot& slot : composed.parameters) {
    if (slot.binding == BindingTime::specialization) text += fmt::format("/{}={}", slot.constant_id, slot.value);
  }
  return text;
}

}  // namespace

Result<int> SharedPrograms::index_of(const ComposedProgram& composed, std::string_view shader_target, Job& job) {
  auto [known, is_new] = indices_.try_emplace(identity(composed), static_cast<int>(job.programs.size()));
  if (!is_new) return known->second;
  Result<PreparedProgram> prepared = prepare_composed(composed, shader_target);
  if (!prepared) return tl::unexpected(prepared.error());
  job.programs.push_back(std::move(prepared->program));
  return known->second;
}

namespace {

/// The maps that axes need, whatever their values.
void add_maps_of_axes(const std::vector<Parameter>& parameters, std::vector<std::string>& maps) {
  for (const Parameter& axis : parameters) {
    for (const auto& needed : axis.maps) {
      for (const std::string& map : needed) add_once(maps, map);
    }
  }
}

template <class Descriptor>
void add_all_maps(const Descriptor& descriptor, std::vector<std::string>& maps) {
  for (const std::string& map : descriptor.maps) add_once(maps, map);
  add_maps_of_axes(descriptor.parameters, maps);
}

/// Drops the values of parameters that the permutation does not have, given those of its axes that `kept` has.
Status keep_values_of(const Registry& registry, const Permutation& kept, Permutation& permutation, bool axes_only) {
  const Result<Parts> parts = resolve(registry, kept);
  if (!parts) return tl::unexpected(parts.error());
  std::erase_if(permutation.values, [&](const auto& entry) {
    return std::none_of(parts->parameters.begin(), parts->parameters.end(), [&](const ParameterSlot& slot) {
      return slot.name == entry.first && !(axes_only && slot.choices.empty());
    });
  });
  return {};
}

}  // namespace

Result<ComposedProgram> compose_known(const Registry& registry, Permutation permutation) {
  // Axes decide which maps there are, and so which parameters.
  Permutation defaults = permutation;
  defaults.values.clear();
  Permutation axes = permutation;
  if (Status status = keep_values_of(registry, defaults, axes, true); !status) return tl::unexpected(status.error());
  if (Status status = keep_values_of(registry, axes, permutation, false); !status)
    return tl::unexpected(status.error());
  return compose(registry, permutation);
}

Result<PreparedProgram> prepare(const Registry& registry, Permutation permutation, std::string_view shader_target) {
  Result<ComposedProgram> composed = compose_known(registry, std::move(permutation));
  if (!composed) return tl::unexpected(name_file_on_disk(composed.error(), registry));
  Result<PreparedProgram> prepared = prepare_composed(std::move(*composed), shader_target);
  if (!prepared) return tl::unexpected(name_file_on_disk(prepared.error(), registry));
  return prepared;
}

Result<std::vector<std::string>> required_maps(const Registry& registry, std::string_view stage_name,
                                               std::string_view technique_name) {
  Result<const StageDescriptor*> stage = registry.stage(stage_name);
  if (!stage) return tl::unexpected(stage.error());
  std::vector<std::string> maps;
  add_all_maps(**stage, maps);
  if (!technique_name.empty()) {
    Result<const TechniqueDescriptor*> technique = registry.technique(technique_name);
    if (!technique) return tl::unexpected(technique.error());
    add_all_maps(**technique, maps);
  }
  // Maps have axes that need maps too, so the list grows while it is read.
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto map = registry.maps.find(maps[i]);
    if (map != registry.maps.end()) add_maps_of_axes(map->second.parameters, maps);
  }
  return maps;
}

Buffer make_buffer(std::string name, const void* data, std::size_t size) {
  Buffer buffer{std::move(name), size, std::vector<std::byte>(size)};
  std::memcpy(buffer.data.data(), data, size);
  return buffer;
}

int bind_buffer(int set, int binding, Buffer buffer, Job& job, std::vector<ResourceBinding>& resources) {
  int index = static_cast<int>(job.buffers.size());
  job.buffers.push_back(std::move(buffer));
  resources.push_back({set, binding, index});
  return index;
}

namespace {

/// The value of the axis `height.format` in a program.
std::string height_format(const ComposedProgram& composed) {
  for (const ParameterSlot& slot : composed.parameters) {
    if (slot.name == "height.format") return slot.choices[static_cast<std::size_t>(slot.value)];
  }
  return "red";
}

Texture texture_of(const ComposedProgram& composed, const MapData& map) {
  if (map.name != "height") return map_texture(map);
  Result<Texture> texture = height_texture(map, height_format(composed));
  return texture ? *std::move(texture) : map_texture(map);  // the axis has only values that there are
}

std::string texture_name(const ComposedProgram& composed, const std::string& map) {
  const std::string format = map == "height" ? height_format(composed) : "red";
  return format == "red" ? map : map + " (" + format + ")";
}

}  // namespace

Status check_height(const MapSet& maps) {
  if (maps.contains("height")) return {};
  return fail(ErrorCode::usage, "maps.missing", "the set of maps lacks the height map; expected it there (map_set)");
}

Status bind_maps(const ComposedProgram& composed, const MapSet& maps, Job& job,
                 std::vector<ResourceBinding>& resources) {
  for (const MapSlot& slot : composed.maps) {
    const auto map = maps.find(slot.map);
    if (map == maps.end()) {
      return fail(ErrorCode::usage, "maps.missing",
                  fmt::format("'{}' reads the map '{}', which the set of maps lacks; expected it baked (bake_map)",
                              composed.key, slot.map));
    }
    const std::string name = texture_name(composed, slot.map);
    auto known =
        std::find_if(job.textures.begin(), job.textures.end(), [&](const Texture& t) { return t.name == name; });
    int index = static_cast<int>(known - job.textures.begin());
    if (known == job.textures.end()) job.textures.push_back(texture_of(composed, map->second));
    resources.push_back({slot.set, slot.binding, index});
  }
  return {};
}

void bind_parameters(const ComposedProgram& composed, Job& job, std::vector<ResourceBinding>& resources) {
  if (composed.parameter_block_size == 0) return;
  std::vector<std::byte> block = parameter_block(composed);
  bind_buffer(0, 0, make_buffer("Parameters", block.data(), block.size()), job, resources);
}

void keep_contract(const ShaderProgram& program, std::vector<ResourceBinding>& resources) {
  std::erase_if(resources, [&](const ResourceBinding& r) {
    return std::none_of(program.bindings.begin(), program.bindings.end(),
                        [&](const BindingSlot& s) { return s.set == r.set && s.binding == r.binding; });
  });
}

void keep_filters(Job& job) {
  std::set<int> filtered;
  const auto add = [&](int program, const std::vector<ResourceBinding>& resources) {
    for (const BindingSlot& slot : job.programs[static_cast<std::size_t>(program)].bindings) {
      for (const ResourceBinding& bound : resources) {
        if (slot.is_filtered && slot.set == bound.set && slot.binding == bound.binding) filtered.insert(bound.resource);
      }
    }
  };
  for (const Command& command : job.commands)
    std::visit([&](const auto& one) { add(one.program, one.resources); }, command);
  for (std::size_t k = 0; k < job.textures.size(); ++k) {
    if (!filtered.contains(static_cast<int>(k))) job.textures[k].sampler.min_mag = TexelFilter::nearest;
  }
}

void append_messages(const JobResult& result, std::vector<std::string>* messages) {
  if (messages) messages->insert(messages->end(), result.messages.begin(), result.messages.end());
}

}  // namespace relievo
