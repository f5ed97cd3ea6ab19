/// From the values of a manifest's axes to a permutation.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "permute/axes.hpp"

namespace relievo {

/// Remembers what it looked up; one a thread.
class PermutationBuilder {
 public:
  /// Both must outlive it.
  PermutationBuilder(const Registry& registry, const std::vector<ResolvedAxis>& axes)
      : registry_(registry), axes_(axes) {}

  /// `values`: an index an axis. Those of axes that the permutation does not have become kNoValue.
  Result<Permutation> build(std::vector<std::uint16_t>& values);

  /// Whether permutations with this stage and these techniques may have the axis.
  bool may_have(const ResolvedAxis& axis, const Permutation& head);

  /// The axes that a stage's roles are bound by: one a role that has an axis of its own, and the one of all others.
  /// An index beyond the last axis stands for the one that is missing.
  std::vector<std::size_t> technique_axes(const StageDescriptor& stage) const;

  std::size_t index_of(AxisKind kind, std::string_view role = {}) const;

 private:
  const std::vector<OwnedParameter>& parameters_within(const Permutation& head);
  const std::vector<std::string>& present_names(const Permutation& permutation);
  void drop_absent(Permutation& permutation, std::vector<std::uint16_t>& values);

  const Registry& registry_;
  const std::vector<ResolvedAxis>& axes_;
  std::unordered_map<std::string, std::vector<OwnedParameter>> within_;  // by head
  std::unordered_map<std::string, std::vector<std::string>> present_;    // by head and axes
};

}  // namespace relievo
