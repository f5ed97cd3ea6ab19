/// A manifest's axes, resolved against the registry.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relievo/permute.hpp"

namespace relievo {

enum class AxisKind { technique, role, stage, address, filter, aov, count, parameter };

/// A manifest's axis with its names known.
struct ResolvedAxis {
  AxisKind kind = AxisKind::parameter;
  std::string role;     ///< of kind `role`
  ArchiveAxis archive;  ///< its values, as the composer would print them
  const ManifestAxis* manifest = nullptr;

  /// Whether it stands for this parameter ("surface.depth_write").
  bool names(std::string_view parameter) const;
};

/// A parameter with its qualified name.
struct OwnedParameter {
  std::string name;
  const Parameter* parameter = nullptr;
};

/// Those of a descriptor.
void add_parameters(const std::string& owner, const std::vector<Parameter>& parameters,
                    std::vector<OwnedParameter>& all);

/// Those of every descriptor.
std::vector<OwnedParameter> parameters_of(const Registry& registry);

/// By an axis's name; whatever is no built-in one counts as a parameter.
AxisKind kind_of(const std::string& name);

/// What an axis that is no parameter may be, its default first.
std::vector<std::string> known_values(const Registry& registry, AxisKind kind);

/// The manifest's rules name what there is: techniques, stages, maps, parameters, values. Errors:
/// "permute.unknown-subject", "permute.value", at the rule's line.
Status check_rules(const Registry& registry, const Manifest& manifest);

/// Errors: "permute.unknown-axis", "permute.value", "permute.duplicate", at the manifest's line.
Result<std::vector<ResolvedAxis>> resolve_axes(const Registry& registry, const Manifest& manifest);

/// Puts the value of an axis into the permutation; of a parameter, wherever `parameters` has one that the axis stands
/// for. Errors: "permute.value".
Status apply_axis(const ResolvedAxis& axis, std::size_t value, const std::vector<OwnedParameter>& parameters,
                  Permutation& permutation);

}  // namespace relievo
