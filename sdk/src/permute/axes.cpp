#include "permute/axes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace relievo {

namespace {

constexpr std::string_view role_prefix = "technique.";
const std::vector<std::string> switch_names = {"off", "on"};

tl::unexpected<Error> fail_at(const Manifest& manifest, const ManifestAxis& axis, std::string id, std::string message) {
  return fail(ErrorCode::descriptor, std::move(id), std::move(message), manifest.file, axis.line, 1);
}

template <class Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& [name, descriptor] : table) names.push_back(name);
  return names;
}

template <class Enum>
std::vector<std::string> enum_names(Enum last) {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last); ++i) names.emplace_back(to_string(static_cast<Enum>(i)));
  return names;
}

}  // namespace

AxisKind kind_of(const std::string& name) {
  constexpr std::pair<std::string_view, AxisKind> built_in[] = {
      {"technique", AxisKind::technique}, {"stage", AxisKind::stage}, {"address", AxisKind::address},
      {"filter", AxisKind::filter},       {"aov", AxisKind::aov},     {"count", AxisKind::count}};
  for (const auto& [known, kind] : built_in) {
    if (name == known) return kind;
  }
  return name.starts_with(role_prefix) ? AxisKind::role : AxisKind::parameter;
}

std::vector<std::string> known_values(const Registry& registry, AxisKind kind) {
  switch (kind) {
    case AxisKind::technique:
    case AxisKind::role:
      return names_of(registry.techniques);
    case AxisKind::stage:
      return names_of(registry.stages);
    case AxisKind::address:
      return enum_names(AddressMode::clip);
    case AxisKind::filter:
      return enum_names(HeightFilter::exact);
    case AxisKind::aov:
      return enum_names(Aov::ray_direction);
    case AxisKind::count:
      return switch_names;
    case AxisKind::parameter:
      break;
  }
  return {};
}

std::vector<OwnedParameter> parameters_of(const Registry& registry) {
  std::vector<OwnedParameter> all;
  for (const auto& [name, technique] : registry.techniques) add_parameters(name, technique.parameters, all);
  for (const auto& [name, stage] : registry.stages) add_parameters(name, stage.parameters, all);
  for (const auto& [name, map] : registry.maps) add_parameters(name, map.parameters, all);
  return all;
}

namespace {

/// `technique = "all"`: every technique that is one, not the truth that others are judged by.
std::vector<std::string> all_techniques(const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& [name, technique] : registry.techniques) {
    if (technique.technique_class != TechniqueClass::reference) names.push_back(name);
  }
  return names;
}

Result<std::vector<std::string>> built_in_values(const Registry& registry, const Manifest& manifest,
                                                 const ManifestAxis& axis, AxisKind kind) {
  const std::vector<std::string> known = known_values(registry, kind);
  const bool is_technique = kind == AxisKind::technique || kind == AxisKind::role;
  if (axis.values == std::vector<std::string>{"all"}) return is_technique ? all_techniques(registry) : known;
  for (const std::string& value : axis.values) {
    if (std::find(known.begin(), known.end(), value) != known.end()) continue;
    const std::string nearest = nearest_name(value, known);
    return fail_at(manifest, axis, "permute.value",
                   fmt::format("axis \"{}\" has the value \"{}\"; {}", axis.name, value,
                               nearest.empty() ? fmt::format("one of {} is expected", fmt::join(known, ", "))
                                               : fmt::format("did you mean \"{}\"?", nearest)));
  }
  return axis.values;
}

/// A parameter's values as texts that `value_text` would give, so that 16 and 16.0 are one.
Result<std::vector<std::string>> parameter_values(const Manifest& manifest, const ManifestAxis& axis,
                                                  const std::vector<OwnedParameter>& owners) {
  if (axis.values == std::vector<std::string>{"all"} && !owners.front().parameter->choices.empty())
    return owners.front().parameter->choices;
  std::vector<std::string> values;
  for (const std::string& text : axis.values) {
    const Parameter* parameter = owners.front().parameter;
    for (const OwnedParameter& owner : owners) {
      if (parse_value(*owner.parameter, text)) parameter = owner.parameter;
    }
    const Result<double> value = parse_value(*parameter, text);
    if (!value) {
      return fail_at(manifest, axis, "permute.value", fmt::format("axis \"{}\": {}", axis.name, value.error().message));
    }
    if (*value < parameter->minimum || *value > parameter->maximum) {
      return fail_at(manifest, axis, "permute.value",
                     fmt::format("axis \"{}\" has the value {}; {} to {} is expected", axis.name, text,
                                 parameter->minimum, parameter->maximum));
    }
    values.push_back(value_text(*parameter, *value));
  }
  return values;
}

/// What a permutation has without being told: the first value of the enumerations, and the descriptor's default.
std::string natural_default(AxisKind kind, const std::vector<OwnedParameter>& owners) {
  switch (kind) {
    case AxisKind::address:
      return std::string(to_string(AddressMode::repeat));
    case AxisKind::filter:
      return std::string(to_string(HeightFilter::exact));
    case AxisKind::aov:
      return std::string(to_string(Aov::color));
    case AxisKind::count:
      return switch_names.front();
    case AxisKind::parameter:
      return value_text(*owners.front().parameter, owners.front().parameter->value);
    default:
      return {};
  }
}

void set_default(const std::vector<OwnedParameter>& owners, ResolvedAxis& axis) {
  std::string wanted = axis.manifest->default_value;
  if (wanted.empty()) wanted = natural_default(axis.kind, owners);
  if (!owners.empty() && !axis.manifest->default_value.empty()) {
    if (const Result<double> value = parse_value(*owners.front().parameter, wanted))
      wanted = value_text(*owners.front().parameter, *value);
  }
  const std::vector<std::string>& values = axis.archive.values;
  const auto found = std::find(values.begin(), values.end(), wanted);
  axis.archive.default_value = found == values.end() ? 0 : static_cast<std::uint16_t>(found - values.begin());
}

std::vector<OwnedParameter> owners_named(const ResolvedAxis& axis, const std::vector<OwnedParameter>& all) {
  std::vector<OwnedParameter> owners;
  std::copy_if(all.begin(), all.end(), std::back_inserter(owners),
               [&](const OwnedParameter& owned) { return axis.names(owned.name); });
  return owners;
}

tl::unexpected<Error> unknown_axis(const Manifest& manifest, const ManifestAxis& axis,
                                   const std::vector<OwnedParameter>& all) {
  std::vector<std::string> known = {"technique", "stage", "address", "filter", "aov", "count"};
  for (const OwnedParameter& owned : all) known.push_back(owned.name);
  const std::string nearest = nearest_name(axis.name, known);
  return fail_at(manifest, axis, "permute.unknown-axis",
                 fmt::format("axis \"{}\" is unknown{}", axis.name,
                             nearest.empty() ? "; technique, stage, address, filter, aov, count or a parameter such as "
                                               "\"relief.linear_steps\" is expected"
                                             : fmt::format("; did you mean \"{}\"?", nearest)));
}

Result<ResolvedAxis> resolve_axis(const Registry& registry, const Manifest& manifest, const ManifestAxis& axis,
                                  const std::vector<OwnedParameter>& all) {
  ResolvedAxis resolved;
  resolved.kind = kind_of(axis.name);
  resolved.manifest = &axis;
  resolved.archive.name = axis.name;
  if (resolved.kind == AxisKind::role) resolved.role = axis.name.substr(role_prefix.size());
  const std::vector<OwnedParameter> owners =
      resolved.kind == AxisKind::parameter ? owners_named(resolved, all) : std::vector<OwnedParameter>();
  if (resolved.kind == AxisKind::parameter && owners.empty()) return unknown_axis(manifest, axis, all);
  Result<std::vector<std::string>> values = resolved.kind == AxisKind::parameter
                                                ? parameter_values(manifest, axis, owners)
                                                : built_in_values(registry, manifest, axis, resolved.kind);
  if (!values) return tl::unexpected(values.error());
  std::vector<std::string> sorted = *values;
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end()) {
    return fail_at(manifest, axis, "permute.duplicate",
                   fmt::format("axis \"{}\" has the value {} twice; once is expected", axis.name, *twice));
  }
  resolved.archive.values = *std::move(values);
  if (resolved.archive.values.size() >= kNoValue) {
    return fail_at(manifest, axis, "permute.value",
                   fmt::format("axis \"{}\" has {} values; at most {} are expected", axis.name,
                               resolved.archive.values.size(), kNoValue - 1));
  }
  set_default(owners, resolved);
  return resolved;
}

}  // namespace

bool ResolvedAxis::names(std::string_view parameter) const {
  if (kind != AxisKind::parameter) return false;
  if (parameter == manifest->name) return true;
  return parameter.substr(parameter.find('.') + 1) == manifest->name;
}

void add_parameters(const std::string& owner, const std::vector<Parameter>& parameters,
                    std::vector<OwnedParameter>& all) {
  for (const Parameter& parameter : parameters) all.push_back({owner + "." + parameter.name, &parameter});
}

Result<std::vector<ResolvedAxis>> resolve_axes(const Registry& registry, const Manifest& manifest) {
  const std::vector<OwnedParameter> all = parameters_of(registry);
  std::vector<ResolvedAxis> axes;
  for (const ManifestAxis& axis : manifest.axes) {
    Result<ResolvedAxis> resolved = resolve_axis(registry, manifest, axis, all);
    if (!resolved) return tl::unexpected(resolved.error());
    axes.push_back(*std::move(resolved));
  }
  return axes;
}

Status apply_axis(const ResolvedAxis& axis, std::size_t index, const std::vector<OwnedParameter>& parameters,
                  Permutation& permutation) {
  const std::string& text = axis.archive.values[index];
  switch (axis.kind) {
    case AxisKind::technique:
      for (auto& [role, technique] : permutation.roles) {
        if (technique.empty()) technique = text;
      }
      break;
    case AxisKind::role:
      permutation.roles[axis.role] = text;
      break;
    case AxisKind::stage:
      permutation.stage = text;
      break;
    case AxisKind::address:
      permutation.address = *parse_address_mode(text);
      break;
    case AxisKind::filter:
      permutation.filter = *parse_height_filter(text);
      break;
    case AxisKind::aov:
      permutation.aov = *parse_aov(text);
      break;
    case AxisKind::count:
      permutation.count_cost = text == switch_names.back();
      break;
    case AxisKind::parameter:
      for (const OwnedParameter& owned : parameters) {
        if (!axis.names(owned.name)) continue;
        const Result<double> value = parse_value(*owned.parameter, text);
        if (!value) {
          Error error = value.error();
          error.id = "permute.value";
          error.message = fmt::format("{}: {}", owned.name, error.message);
          return tl::unexpected(error);
        }
        permutation.values[owned.name] = *value;
        if (axis.manifest->binding) permutation.binding_times[owned.name] = *axis.manifest->binding;
      }
      break;
  }
  return {};
}

}  // namespace relievo
