#include "describe/registry_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "describe/descriptor_place.hpp"
#include "describe/source_path.hpp"
#include "describe/toml_reader.hpp"

namespace relievo {
namespace {

tl::unexpected<Error> fail_at(const Registry& registry, std::string id, std::string message, const std::string& file,
                              std::string_view key, std::string_view item = {}) {
  const auto source = registry.sources.find(file);
  const Place place = source == registry.sources.end() ? Place{} : find_place(source->second, key, item);
  return fail(ErrorCode::descriptor, std::move(id), std::move(message), file, place.line, place.column);
}

Status check_file(const Registry& registry, const std::string& file, const std::string& wanted, const char* key) {
  if (wanted.empty() || registry.sources.contains(wanted)) return {};
  const std::string folder = folder_of(file) + "/";
  std::vector<std::string> known;
  for (auto it = registry.sources.lower_bound(folder); it != registry.sources.end(); ++it) {
    if (!it->first.starts_with(folder)) break;
    if (it->first.ends_with(".glsl")) known.push_back(it->first);
  }
  return fail_at(registry, "describe.missing-file",
                 fmt::format("the file {} does not exist{}", quote_path(wanted), suggest(wanted, known)), file, key);
}

Status check_files(const Registry& registry) {
  Status status;
  const auto check = [&](const std::string& file, const std::string& wanted, const char* key) {
    if (status) status = check_file(registry, file, wanted, key);
  };
  for (const auto& [name, technique] : registry.techniques) check(technique.file, technique.module, "module");
  for (const auto& [name, map] : registry.maps) {
    check(map.file, map.module, "module");
    check(map.file, map.access, "access");
  }
  for (const auto& [name, stage] : registry.stages) {
    for (const StageShader& shader : stage.shaders) check(stage.file, shader.module, "shader");
  }
  return status;
}

Status check_maps_exist(const Registry& registry) {
  Status status;
  std::vector<std::string> known;
  for (const auto& [name, map] : registry.maps) known.push_back(name);
  const auto check = [&](const std::string& owner, const std::string& file, const std::vector<std::string>& maps,
                         const char* key) {
    for (const std::string& wanted : maps) {
      if (!status || registry.maps.contains(wanted)) continue;
      status = fail_at(registry, "describe.unknown-map",
                       fmt::format("the {} requires the map {}, which nobody provides{}", owner, quote(wanted),
                                   suggest(wanted, known)),
                       file, key, wanted);
    }
  };
  const auto check_axes = [&](const auto& descriptor, const std::string& owner) {
    for (const Parameter& axis : descriptor.parameters) {
      for (const auto& maps : axis.maps)
        check(fmt::format("axis {} of the {}", quote(axis.name), owner), descriptor.file, maps, "maps");
    }
  };
  for (const auto& [name, technique] : registry.techniques) {
    check("technique " + quote(name), technique.file, technique.maps, "maps");
    check_axes(technique, "technique " + quote(name));
  }
  for (const auto& [name, stage] : registry.stages) {
    check("stage " + quote(name), stage.file, stage.maps, "maps");
    check_axes(stage, "stage " + quote(name));
  }
  for (const auto& [name, map] : registry.maps) {
    check("map " + quote(name), map.file, map.inputs, "inputs");
    check_axes(map, "map " + quote(name));
  }
  return status;
}

Status check_bindings(const Registry& registry) {
  std::map<std::pair<int, int>, std::string> bindings;
  std::map<std::string, std::string> samplers;
  for (const auto& [name, map] : registry.maps) {
    const auto [same_binding, is_new_binding] = bindings.try_emplace({map.set, map.binding}, name);
    if (!is_new_binding) {
      return fail_at(registry, "describe.binding-collision",
                     fmt::format("the map {} has set {}, binding {}, which the map {} has already", quote(name),
                                 map.set, map.binding, quote(same_binding->second)),
                     map.file, "binding");
    }
    const auto [same_sampler, is_new_sampler] = samplers.try_emplace(map.sampler, name);
    if (!is_new_sampler) {
      return fail_at(registry, "describe.binding-collision",
                     fmt::format("the map {} has the sampler {}, which the map {} has already", quote(name),
                                 quote(map.sampler), quote(same_sampler->second)),
                     map.file, "sampler");
    }
  }
  return {};
}

/// `a`'s parameter `b_c` and `a_b`'s parameter `c` are the same GLSL identifier; a stage and several techniques share a
/// shader, and so may two owners of one name.
Status check_identifiers(const Registry& registry) {
  Status status;
  std::map<std::string, std::string> owners;
  const auto check = [&](const std::string& kind, const auto& descriptor) {
    for (const Parameter& parameter : descriptor.parameters) {
      const std::string identifier = descriptor.name + "_" + parameter.name;
      const auto [same, is_new] = owners.try_emplace(identifier, fmt::format("{} {}", kind, quote(descriptor.name)));
      if (is_new || !status) continue;
      status = fail(ErrorCode::descriptor, "describe.duplicate",
                    fmt::format("{} of the {} {} is {} in GLSL, as is a parameter of the {}", quote(parameter.name),
                                kind, quote(descriptor.name), quote(identifier), same->second),
                    descriptor.file, parameter.line, 1);
    }
  };
  for (const auto& [name, technique] : registry.techniques) check("technique", technique);
  for (const auto& [name, stage] : registry.stages) check("stage", stage);
  return status;
}

/// Follows `next` from `start` until a name comes again; the names from there on are the cycle.
template <class Next>
std::string cycle_text(const std::string& start, Next next) {
  std::vector<std::string> path = {start};
  for (;;) {
    const std::string name = next(path.back());
    const auto first = std::find(path.begin(), path.end(), name) - path.begin();
    path.push_back(name);
    if (first + 1 < std::ssize(path)) return fmt::format("{}", fmt::join(path.begin() + first, path.end(), " → "));
  }
}

/// Takes away, again and again, the maps all of whose inputs are gone: what cannot go has a cycle below it.
Status check_map_cycles(const Registry& registry) {
  std::map<std::string, const MapDescriptor*, std::less<>> left;
  for (const auto& [name, map] : registry.maps) left.emplace(name, &map);
  const auto is_left = [&](const std::string& name) { return left.contains(name); };
  const auto has_input_left = [&](const MapDescriptor& map) {
    return std::any_of(map.inputs.begin(), map.inputs.end(), is_left);
  };
  while (std::erase_if(left, [&](const auto& entry) { return !has_input_left(*entry.second); }) > 0) {
  }
  if (left.empty()) return {};
  const MapDescriptor& map = *left.begin()->second;
  const auto first_input_left = [&](const std::string& name) {
    const std::vector<std::string>& inputs = left.at(name)->inputs;
    return *std::find_if(inputs.begin(), inputs.end(), is_left);
  };
  return fail_at(
      registry, "describe.cycle",
      fmt::format("the inputs of the map {} form a cycle: {}", quote(map.name), cycle_text(map.name, first_input_left)),
      map.file, "inputs", first_input_left(map.name));
}

Status check_fallback_cycles(const Registry& registry) {
  const auto fallback_of = [&](const std::string& name) {
    const auto stage = registry.stages.find(name);
    return stage == registry.stages.end() ? std::string() : stage->second.fallback;
  };
  for (const auto& [start, stage] : registry.stages) {
    std::size_t steps = 0;
    std::string name = start;
    while (!name.empty() && steps <= registry.stages.size()) {
      name = fallback_of(name);
      ++steps;
    }
    if (name.empty()) continue;
    return fail_at(
        registry, "describe.cycle",
        fmt::format("the fallbacks of the stage {} form a cycle: {}", quote(start), cycle_text(start, fallback_of)),
        stage.file, "fallback");
  }
  return {};
}

}  // namespace

Status check_registry(const Registry& registry) {
  Status status;
  for (const auto check :
       {check_files, check_maps_exist, check_bindings, check_identifiers, check_map_cycles, check_fallback_cycles}) {
    if (status) status = check(registry);
  }
  return status;
}

}  // namespace relievo
