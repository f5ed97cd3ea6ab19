#include "permute/builder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compose/resolve.hpp"

namespace relievo {

namespace {

using Seen = std::vector<std::string>;

bool is_in(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void add_map(const Registry& registry, const std::string& name, Seen& seen, std::vector<OwnedParameter>& all);

void add_axis_maps(const Registry& registry, const std::vector<Parameter>& parameters, Seen& seen,
                   std::vector<OwnedParameter>& all) {
  for (const Parameter& axis : parameters) {
    for (const auto& maps : axis.maps) {
      for (const std::string& map : maps) add_map(registry, map, seen, all);
    }
  }
}

void add_map(const Registry& registry, const std::string& name, Seen& seen, std::vector<OwnedParameter>& all) {
  const auto map = registry.maps.find(name);
  if (map == registry.maps.end() || is_in(seen, name)) return;
  seen.push_back(name);
  add_parameters(name, map->second.parameters, all);
  add_axis_maps(registry, map->second.parameters, seen, all);
}

template <class Descriptor>
void add_descriptor(const Registry& registry, const Descriptor& descriptor, Seen& seen,
                    std::vector<OwnedParameter>& all) {
  add_parameters(descriptor.name, descriptor.parameters, all);
  for (const std::string& map : descriptor.maps) add_map(registry, map, seen, all);
  add_axis_maps(registry, descriptor.parameters, seen, all);
}

std::string head_key(const Permutation& head) {
  std::string key = head.stage;
  for (const auto& [role, technique] : head.roles) key += " " + technique;
  return key;
}

/// Values of parameters that decide which maps there are.
std::map<std::string, double> axis_values(const Permutation& permutation, const std::vector<OwnedParameter>& all) {
  std::map<std::string, double> values;
  for (const OwnedParameter& owned : all) {
    if (owned.parameter->choices.empty()) continue;
    if (const auto value = permutation.values.find(owned.name); value != permutation.values.end())
      values.insert(*value);
  }
  return values;
}

}  // namespace

std::size_t PermutationBuilder::index_of(AxisKind kind, std::string_view role) const {
  const auto found = std::find_if(axes_.begin(), axes_.end(),
                                  [&](const ResolvedAxis& axis) { return axis.kind == kind && axis.role == role; });
  return static_cast<std::size_t>(found - axes_.begin());
}

std::vector<std::size_t> PermutationBuilder::technique_axes(const StageDescriptor& stage) const {
  std::vector<std::size_t> found;
  for (const std::string& role : stage.roles) {
    const std::size_t own = index_of(AxisKind::role, role);
    const std::size_t axis = own < axes_.size() ? own : index_of(AxisKind::technique);
    if (std::find(found.begin(), found.end(), axis) == found.end()) found.push_back(axis);
  }
  std::sort(found.begin(), found.end());
  return found;
}

const std::vector<OwnedParameter>& PermutationBuilder::parameters_within(const Permutation& head) {
  const auto [entry, is_new] = within_.try_emplace(head_key(head));
  if (!is_new) return entry->second;
  Seen seen, techniques;
  add_descriptor(registry_, registry_.stages.find(head.stage)->second, seen, entry->second);
  for (const auto& [role, name] : head.roles) {
    const auto technique = registry_.techniques.find(name);
    if (technique == registry_.techniques.end() || is_in(techniques, name)) continue;
    techniques.push_back(name);
    add_descriptor(registry_, technique->second, seen, entry->second);
  }
  return entry->second;
}

bool PermutationBuilder::may_have(const ResolvedAxis& axis, const Permutation& head) {
  if (axis.kind != AxisKind::parameter) return true;
  const std::vector<OwnedParameter>& all = parameters_within(head);
  return std::any_of(all.begin(), all.end(), [&](const OwnedParameter& owned) { return axis.names(owned.name); });
}

const std::vector<std::string>& PermutationBuilder::present_names(const Permutation& permutation) {
  const std::map<std::string, double> axes = axis_values(permutation, parameters_within(permutation));
  std::string key = head_key(permutation);
  for (const auto& [name, value] : axes) key += fmt::format(" {}={}", name, value);
  const auto [entry, is_new] = present_.try_emplace(std::move(key));
  if (!is_new) return entry->second;
  Permutation asked = permutation;
  asked.values.clear();
  asked.binding_times.clear();
  // An axis of a map that another axis brings is there at the second look, and what it brings at the third.
  for (int look = 0; look < 3; ++look) {
    const Result<Parts> parts = resolve(registry_, asked);
    if (!parts) break;
    entry->second.clear();
    asked.values.clear();
    for (const ParameterSlot& slot : parts->parameters) {
      entry->second.push_back(slot.name);
      if (const auto value = axes.find(slot.name); value != axes.end()) asked.values.insert(*value);
    }
  }
  return entry->second;
}

/// A parameter of a map that this permutation does without is no part of it, nor is the axis of such parameters.
void PermutationBuilder::drop_absent(Permutation& permutation, std::vector<std::uint16_t>& values) {
  const std::vector<std::string>& present = present_names(permutation);
  std::erase_if(permutation.values, [&](const auto& value) { return !is_in(present, value.first); });
  std::erase_if(permutation.binding_times, [&](const auto& time) { return !is_in(present, time.first); });
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].kind != AxisKind::parameter) continue;
    const bool used =
        std::any_of(present.begin(), present.end(), [&](const std::string& name) { return axes_[i].names(name); });
    if (!used) values[i] = kNoValue;
  }
}

Result<Permutation> PermutationBuilder::build(std::vector<std::uint16_t>& values) {
  Permutation permutation;
  const std::size_t stage_axis = index_of(AxisKind::stage);
  permutation.stage = stage_axis < axes_.size() ? axes_[stage_axis].archive.values[values[stage_axis]] : "surface";
  const Result<const StageDescriptor*> stage = registry_.stage(permutation.stage);
  if (!stage) return tl::unexpected(stage.error());
  for (const std::string& role : (*stage)->roles) permutation.roles[role];
  std::vector<std::size_t> heads = technique_axes(**stage);
  // Roles with an axis of their own first, so that the common one fills what they leave.
  std::stable_partition(heads.begin(), heads.end(), [&](std::size_t i) { return axes_[i].kind == AxisKind::role; });
  Status status;
  for (const std::size_t i : heads) {
    if (status) status = apply_axis(axes_[i], values[i], {}, permutation);
  }
  const std::vector<OwnedParameter>& parameters = parameters_within(permutation);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const AxisKind kind = axes_[i].kind;
    const bool is_head = kind == AxisKind::technique || kind == AxisKind::role || kind == AxisKind::stage;
    if (!status || is_head || values[i] == kNoValue) continue;
    status = apply_axis(axes_[i], values[i], parameters, permutation);
  }
  if (!status) return tl::unexpected(status.error());
  drop_absent(permutation, values);
  return permutation;
}

}  // namespace relievo
