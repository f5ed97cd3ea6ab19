#include <fmt/format.h>

#include <algorithm>

#include "permute/builder.hpp"
#include "permute/closure.hpp"

namespace relievo {

namespace {

using Assignment = std::span<const std::pair<std::string, std::string>>;

Result<std::size_t> find_axis(const PermutationPlan& plan, const std::string& name) {
  std::vector<std::string> names;
  for (const ArchiveAxis& axis : plan.axes) {
    if (axis.name == name) return names.size();
    names.push_back(axis.name);
  }
  const std::string nearest = nearest_name(name, names);
  return fail(ErrorCode::usage, "permute.unknown-axis",
              fmt::format("the manifest has no axis '{}'; {}", name,
                          nearest.empty() ? fmt::format("expected one of {}", fmt::join(names, ", "))
                                          : fmt::format("did you mean '{}'?", nearest)));
}

Result<std::uint16_t> find_value(const ArchiveAxis& axis, const std::string& value) {
  const auto found = std::find(axis.values.begin(), axis.values.end(), value);
  if (found != axis.values.end()) return static_cast<std::uint16_t>(found - axis.values.begin());
  return fail(
      ErrorCode::usage, "permute.value",
      fmt::format("axis '{}' has no value '{}'; expected one of {}", axis.name, value, fmt::join(axis.values, ", ")));
}

/// An index an axis: what is given, else the default.
Result<std::vector<std::uint16_t>> wanted_values(const PermutationPlan& plan, Assignment assignment) {
  std::vector<std::uint16_t> wanted;
  for (const ArchiveAxis& axis : plan.axes) wanted.push_back(axis.default_value);
  for (const auto& [name, value] : assignment) {
    const Result<std::size_t> axis = find_axis(plan, name);
    if (!axis) return tl::unexpected(axis.error());
    const Result<std::uint16_t> index = find_value(plan.axes[*axis], value);
    if (!index) return tl::unexpected(index.error());
    wanted[*axis] = *index;
  }
  return wanted;
}

bool agrees(const PlannedPermutation& planned, const std::vector<std::uint16_t>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (planned.values[i] != kNoValue && planned.values[i] != wanted[i]) return false;
  }
  return true;
}

/// The given axes that the permutation does not have.
std::string foreign_axes(const PermutationPlan& plan, const PlannedPermutation& planned, Assignment assignment) {
  std::string text;
  for (const auto& [name, value] : assignment) {
    const Result<std::size_t> axis = find_axis(plan, name);
    if (axis && planned.values[*axis] == kNoValue) text += fmt::format("\nit does not have the axis {}", name);
  }
  return text;
}

std::string verdicts(const PermutationPlan& plan, const PlannedPermutation& planned) {
  std::string text;
  for (std::size_t i = 0; i < plan.targets.size(); ++i) {
    const std::uint32_t reason = planned.pruned[i];
    text += fmt::format("\n{}: {}", to_string(plan.targets[i]),
                        reason == 0 ? "kept" : fmt::format("pruned: {}", plan.reasons[reason - 1]));
  }
  return text;
}

Result<CacheKey> key_of(const Registry& registry, PermutationBuilder& builder, const PlannedPermutation& planned) {
  std::vector<std::uint16_t> values = planned.values;
  const Result<Permutation> permutation = builder.build(values);
  if (!permutation) return tl::unexpected(permutation.error());
  const Result<Closure> closure = compose_closure(registry, *permutation);
  if (!closure) return tl::unexpected(closure.error());
  return closure_key(*closure, {}, true);
}

/// The permutations that are composed to the same source with the same frozen constants.
Result<std::string> aliases(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                            const PlannedPermutation& planned) {
  const Result<std::vector<ResolvedAxis>> axes = resolve_axes(registry, manifest);
  if (!axes) return tl::unexpected(axes.error());
  PermutationBuilder builder(registry, *axes);
  const Result<CacheKey> key = key_of(registry, builder, planned);
  if (!key) return tl::unexpected(key.error());
  std::vector<std::string> same;
  for (const PlannedPermutation& other : plan.permutations) {
    if (&other == &planned || !other.is_kept()) continue;
    const Result<CacheKey> other_key = key_of(registry, builder, other);
    if (other_key && *other_key == *key) same.push_back(plan.name(other));
  }
  if (same.empty()) return std::string("\nno other permutation has its source");
  return fmt::format("\nits source is that of {} more; the first is {}", same.size(), same.front());
}

}  // namespace

Result<std::string> explain(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                            Assignment assignment) {
  const Result<std::vector<std::uint16_t>> wanted = wanted_values(plan, assignment);
  if (!wanted) return tl::unexpected(wanted.error());
  const auto found = std::find_if(plan.permutations.begin(), plan.permutations.end(),
                                  [&](const PlannedPermutation& planned) { return agrees(planned, *wanted); });
  if (found == plan.permutations.end()) {
    return fail(ErrorCode::usage, "permute.not-asked", "the manifest does not ask for this permutation");
  }
  std::string text = fmt::format("{}\nkey {:016x}", plan.name(*found), found->key);
  text += foreign_axes(plan, *found, assignment) + verdicts(plan, *found);
  if (!found->is_kept()) return text;
  Result<std::string> others = aliases(registry, manifest, plan, *found);
  if (!others) return others;
  return text + *others;
}

}  // namespace relievo
