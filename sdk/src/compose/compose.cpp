#include "relievo/compose.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>

#include "compose/include.hpp"
#include "compose/resolve.hpp"

namespace relievo {

namespace {

/// Numbers that modules may ask for by name; defined for every shader, in one place.
std::string axis_macros(HeightFilter filter, AddressMode address, bool count, Aov aov) {
  std::string text = "#version 450\n#extension GL_GOOGLE_cpp_style_line_directive : require\n";
  constexpr const char* address_names[] = {"REPEAT", "MIRROR", "CLAMP", "CLIP"};
  for (int i = 0; i < 4; ++i) text += fmt::format("#define RELIEVO_ADDRESS_{} {}\n", address_names[i], i);
  constexpr const char* aov_names[] = {"COLOR", "DEPTH",  "NORMAL",     "UV",
                                       "STEPS", "STATUS", "RAY_ORIGIN", "RAY_DIRECTION"};
  for (int i = 0; i < 8; ++i) text += fmt::format("#define RELIEVO_AOV_{} {}\n", aov_names[i], i);
  text += fmt::format("#define RELIEVO_ADDRESS {}\n", static_cast<int>(address));
  text += fmt::format("#define RELIEVO_FILTER_EXACT {}\n", filter == HeightFilter::exact ? 1 : 0);
  text += fmt::format("#define RELIEVO_COUNT {}\n", count ? 1 : 0);
  text += fmt::format("#define RELIEVO_AOV {}\n", static_cast<int>(aov));
  return text;
}

std::string declare_map(const MapDescriptor& map) {
  constexpr std::array<std::string_view, 3> kinds = {"2D", "2DArray", "3D"};
  const std::string_view kind = kinds[static_cast<std::size_t>(map.dimension)];
  const std::string place = fmt::format("set = {}, binding = {}", map.set, map.binding);
  const std::string_view number = map.is_uint ? "u" : "";
  const std::string texture =
      fmt::format("layout({}) uniform highp {}sampler{} {};\n", place, number, kind, map.sampler);
  if (map.image.empty()) return texture;
  return fmt::format(
      "#if {0}_fetch == {0}_fetch_image\nlayout({1}, {2}) readonly uniform highp {3}image{4} {5};\n#else\n{6}#endif\n",
      map.name, place, map.image, number, kind, map.sampler, texture);
}

Result<std::string> declare_maps(const std::vector<const MapDescriptor*>& maps, SourceExpander& expander) {
  std::string text;
  for (const MapDescriptor* map : maps) {
    text += declare_map(*map);
    if (map->access.empty()) continue;
    Result<std::string> access = expander.expand(map->access);
    if (!access) return access;
    text += *access;
  }
  return text;
}

/// Only what a shader's own text asks for goes into it: features that it does not use cost nothing.
Parts parts_used_by(const Registry& registry, const Parts& all, const std::string& module_text) {
  Parts used;
  used.stage = all.stage;
  for (const auto& [role, technique] : all.roles) {
    if (module_text.find("relievo_" + role + "_trace") == std::string::npos) continue;
    used.roles[role] = technique;
    add_once(used.techniques, technique);
    for (const std::string& name : technique->maps) add_once(used.maps, &registry.maps.find(name)->second);
  }
  for (const MapDescriptor* map : all.maps) {
    if (module_text.find("relievo_" + map->name + "_") != std::string::npos) add_once(used.maps, map);
  }
  sort_by_binding(used.maps);
  return used;
}

Result<ComposedShader> compose_shader(const Registry& registry, const Parts& all, const StageShader& shader,
                                      const std::string& macros, const std::vector<ParameterSlot>& slots) {
  SourceExpander scout(registry.sources);
  Result<std::string> alone = scout.expand(shader.module);
  if (!alone) return tl::unexpected(alone.error());
  Parts used = parts_used_by(registry, all, *alone);

  SourceExpander expander(registry.sources);
  std::string text = macros + declare_parameters(slots);
  Result<std::string> maps = declare_maps(used.maps, expander);
  if (!maps) return tl::unexpected(maps.error());
  text += *maps;
  for (const TechniqueDescriptor* technique : used.techniques) {
    Result<std::string> module = expander.expand(technique->module);
    if (!module) return tl::unexpected(module.error());
    text += *module;
  }
  for (const auto& [role, technique] : used.roles)
    text += fmt::format("#define relievo_{}_trace {}_trace\n", role, technique->name);
  Result<std::string> module = expander.expand(shader.module);
  if (!module) return tl::unexpected(module.error());
  text += *module;
  return ComposedShader{shader.stage, std::move(text), expander.files()};
}

Status check_rules(const Parts& parts, const Permutation& permutation) {
  const Rule* broken = broken_rule(parts, facts_of(parts, permutation));
  if (!broken) return {};
  return fail(ErrorCode::usage, "compose.rule",
              fmt::format("permutation '{}' breaks a rule of its axes: {}", permutation.key(), to_string(*broken)),
              broken->file, broken->line);
}

}  // namespace

Result<ComposedProgram> compose(const Registry& registry, const Permutation& permutation) {
  const Result<Parts> parts = resolve(registry, permutation);
  if (!parts) return tl::unexpected(parts.error());
  if (Status status = check_rules(*parts, permutation); !status) return tl::unexpected(status.error());
  return compose_parts(registry, permutation, *parts);
}

Result<ComposedProgram> compose_parts(const Registry& registry, const Permutation& permutation, const Parts& parts) {
  const std::vector<ParameterSlot>& slots = parts.parameters;

  ComposedProgram program;
  program.key = permutation.key();
  program.stage = permutation.stage;
  program.parameters = slots;
  program.parameter_block_size = parameter_block_size(slots);
  program.features = features_of(parts);
  for (const MapDescriptor* map : parts.maps) program.maps.push_back({map->name, map->sampler, map->set, map->binding});
  bool count = permutation.count_cost || permutation.aov == Aov::steps;
  std::string macros = axis_macros(permutation.filter, permutation.address, count, permutation.aov);
  macros += fmt::format("#define RELIEVO_HITS_WITHIN_TILE {}\n", parts.stage->hits_within_tile ? 1 : 0);
  for (const StageShader& shader : parts.stage->shaders) {
    Result<ComposedShader> composed = compose_shader(registry, parts, shader, macros, slots);
    if (!composed) return tl::unexpected(composed.error());
    program.shaders.push_back(std::move(*composed));
  }
  return program;
}

Result<ComposedProgram> compose_bake(const Registry& registry, std::string_view map_name, AddressMode address,
                                     const std::map<std::string, double>& values, BakeProgram bake) {
  Result<const MapDescriptor*> map = registry.map(map_name);
  if (!map) return tl::unexpected(map.error());
  if ((*map)->module.empty()) {
    return fail(ErrorCode::usage, "compose.provided-map",
                fmt::format("map '{}' is given by the caller: there is nothing to bake", map_name));
  }
  const int phases = static_cast<int>((*map)->passes.size());
  if (bake.phase < 0 || bake.phase >= phases || bake.buffers < 1 || bake.buffers > most_bake_buffers) {
    return fail(ErrorCode::usage, "compose.bake",
                fmt::format("map '{}': phase {} into {} buffers; expected a phase from 0 to {} and 1 to {} buffers",
                            map_name, bake.phase, bake.buffers, phases - 1, most_bake_buffers));
  }
  std::vector<const MapDescriptor*> inputs;
  if (Status status = add_maps(registry, (*map)->inputs, inputs); !status) return tl::unexpected(status.error());
  sort_by_binding(inputs);
  std::vector<ParameterOwner> owners = {{(*map)->name, &(*map)->parameters}};
  for (const MapDescriptor* input : inputs) owners.push_back({input->name, &input->parameters});
  Result<std::vector<ParameterSlot>> slots = assign_parameters(owners, values, {});
  if (!slots) return tl::unexpected(slots.error());

  ComposedProgram program;
  program.key = fmt::format("bake={}/{}/{}", map_name, bake.phase, to_string(address));
  program.stage = "bake";
  program.parameters = *slots;
  program.parameter_block_size = parameter_block_size(*slots);
  program.features = (*map)->features;
  for (const MapDescriptor* input : inputs)
    program.maps.push_back({input->name, input->sampler, input->set, input->binding});

  SourceExpander expander(registry.sources);
  std::string text =
      axis_macros(HeightFilter::exact, address, false, Aov::color) +
      fmt::format(
          "#define RELIEVO_BAKE_PHASE {}\n#define RELIEVO_BAKE_BUFFERS {}\n#define RELIEVO_BAKE_LAYERS_AT_ONCE {}\n",
          bake.phase, bake.buffers, (*map)->layers_at_once) +
      declare_parameters(*slots);
  Result<std::string> maps = declare_maps(inputs, expander);
  if (!maps) return tl::unexpected(maps.error());
  Result<std::string> module = expander.expand((*map)->module);
  if (!module) return tl::unexpected(module.error());
  program.shaders.push_back({ShaderStage::compute, text + *maps + *module, expander.files()});
  return program;
}

}  // namespace relievo
