#include "compose/resolve.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace relievo {

namespace {

Status add_role(const Registry& registry, const Permutation& permutation, const std::string& role, Parts& parts) {
  auto bound = permutation.roles.find(role);
  if (bound == permutation.roles.end()) {
    return fail(ErrorCode::usage, "compose.role-missing",
                fmt::format("stage '{}' calls the role '{}', which no technique is bound to", permutation.stage, role));
  }
  Result<const TechniqueDescriptor*> technique = registry.technique(bound->second);
  if (!technique) return tl::unexpected(technique.error());
  parts.roles[role] = *technique;
  add_once(parts.techniques, *technique);
  return add_maps(registry, (*technique)->maps, parts.maps);
}

Status add_roles(const Registry& registry, const Permutation& permutation, Parts& parts) {
  for (const std::string& role : parts.stage->roles) {
    if (Status status = add_role(registry, permutation, role, parts); !status) return status;
  }
  for (const auto& [role, technique] : permutation.roles) {
    if (parts.roles.contains(role)) continue;
    return fail(ErrorCode::usage, "compose.role-unknown",
                fmt::format("stage '{}' has no role '{}'; expected {}", permutation.stage, role,
                            parts.stage->roles.empty() ? "none: it traces nothing"
                                                       : fmt::format("{}", fmt::join(parts.stage->roles, ", "))));
  }
  return {};
}

/// The chosen value of each of the owner's axes, with the axis.
template <class Visit>
void visit_axes(const std::string& owner, const std::vector<Parameter>& parameters, const Permutation& permutation,
                const Visit& visit) {
  for (const Parameter& parameter : parameters) {
    if (parameter.choices.empty()) continue;
    const auto given = permutation.values.find(owner + "." + parameter.name);
    const double value = given == permutation.values.end() ? parameter.value : given->second;
    if (value >= 0 && value < static_cast<double>(parameter.choices.size()))
      visit(parameter, static_cast<std::size_t>(value));
  }
}

/// Maps that chosen values of axes need; a map may have such axes itself, so the list grows while it is read.
Status add_maps_of_axes(const Registry& registry, const Permutation& permutation, Parts& parts) {
  Status status;
  const auto add = [&](const Parameter& axis, std::size_t value) {
    if (status) status = add_maps(registry, axis.maps[value], parts.maps);
  };
  visit_axes(parts.stage->name, parts.stage->parameters, permutation, add);
  for (const TechniqueDescriptor* technique : parts.techniques)
    visit_axes(technique->name, technique->parameters, permutation, add);
  for (std::size_t i = 0; i < parts.maps.size(); ++i) {
    const MapDescriptor* map = parts.maps[i];
    visit_axes(map->name, map->parameters, permutation, add);
  }
  return status;
}

std::vector<ParameterOwner> owners_of(const Parts& parts) {
  std::vector<ParameterOwner> owners = {{parts.stage->name, &parts.stage->parameters}};
  for (const TechniqueDescriptor* technique : parts.techniques)
    owners.push_back({technique->name, &technique->parameters});
  for (const MapDescriptor* map : parts.maps) owners.push_back({map->name, &map->parameters});
  return owners;
}

/// Calls visit(parameter, its slot): slots lie in the order of the owners' declarations.
template <class Visit>
void visit_parameters(const Parts& parts, const Visit& visit) {
  std::size_t slot = 0;
  for (const ParameterOwner& owner : owners_of(parts)) {
    for (const Parameter& parameter : *owner.parameters) visit(parameter, parts.parameters[slot++]);
  }
}

}  // namespace

Status add_maps(const Registry& registry, const std::vector<std::string>& names,
                std::vector<const MapDescriptor*>& maps) {
  for (const std::string& name : names) {
    Result<const MapDescriptor*> map = registry.map(name);
    if (!map) return tl::unexpected(map.error());
    add_once(maps, *map);
  }
  return {};
}

void sort_by_binding(std::vector<const MapDescriptor*>& maps) {
  std::sort(maps.begin(), maps.end(), [](const MapDescriptor* a, const MapDescriptor* b) {
    return std::pair(a->set, a->binding) < std::pair(b->set, b->binding);
  });
}

Result<Parts> resolve(const Registry& registry, const Permutation& permutation) {
  Parts parts;
  Result<const StageDescriptor*> stage = registry.stage(permutation.stage);
  if (!stage) return tl::unexpected(stage.error());
  parts.stage = *stage;
  Status status = add_maps(registry, parts.stage->maps, parts.maps);
  if (status) status = add_roles(registry, permutation, parts);
  if (status) status = add_maps_of_axes(registry, permutation, parts);
  if (!status) return tl::unexpected(status.error());
  sort_by_binding(parts.maps);
  Result<std::vector<ParameterSlot>> slots =
      assign_parameters(owners_of(parts), permutation.values, permutation.binding_times);
  if (!slots) return tl::unexpected(slots.error());
  parts.parameters = *std::move(slots);
  return parts;
}

FeatureSet features_of(const Parts& parts) {
  FeatureSet features = parts.stage->features;
  for (const TechniqueDescriptor* technique : parts.techniques) {
    features.insert(technique->features.begin(), technique->features.end());
  }
  visit_parameters(parts, [&](const Parameter& axis, const ParameterSlot& slot) {
    if (axis.features.empty()) return;
    const FeatureSet& needed = axis.features[static_cast<std::size_t>(slot.value)];
    features.insert(needed.begin(), needed.end());
  });
  return features;
}

Facts facts_of(const Parts& parts, const Permutation& permutation) {
  Facts facts;
  facts["stage"] = {parts.stage->name};
  for (const auto& [role, technique] : parts.roles) {
    facts["technique"].insert(technique->name);
    facts["technique." + role] = {technique->name};
  }
  facts["address"] = {std::string(to_string(permutation.address))};
  facts["filter"] = {std::string(to_string(permutation.filter))};
  facts["aov"] = {std::string(to_string(permutation.aov))};
  facts["count"] = {permutation.count_cost ? "on" : "off"};
  facts["features"] = features_of(parts);
  std::set<std::string>& maps = facts["maps"];
  for (const MapDescriptor* map : parts.maps) maps.insert(map->name);
  visit_parameters(parts, [&](const Parameter& parameter, const ParameterSlot& slot) {
    facts[slot.name] = {value_text(parameter, slot.value)};
  });
  return facts;
}

const Rule* broken_rule(const Parts& parts, const Facts& facts) {
  const Rule* broken = nullptr;
  visit_parameters(parts, [&](const Parameter& parameter, const ParameterSlot&) {
    for (const Rule& rule : parameter.rules) {
      if (!broken && is_broken(rule, facts)) broken = &rule;
    }
  });
  return broken;
}

}  // namespace relievo
