#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "permute/builder.hpp"
#include "permute/prune.hpp"

namespace relievo {

namespace {

constexpr double most_permutations = 1e7;

class Planner {
 public:
  Planner(const Registry& registry, const Manifest& manifest, std::vector<ResolvedAxis> axes)
      : registry_(registry), manifest_(manifest), axes_(std::move(axes)), builder_(registry, axes_), pruner_(manifest) {
    plan_.targets = manifest.targets;
    for (const ResolvedAxis& axis : axes_) plan_.axes.push_back(axis.archive);
  }

  Result<PermutationPlan> run() {
    for (const bool only_counts : {true, false}) {  // too many are refused before time goes into them
      only_counts_ = only_counts;
      for (const std::string& stage : stages()) {
        if (Status status = add_stage(stage); !status) return tl::unexpected(in_manifest(status.error()));
      }
    }
    // What differs only in axes that a permutation turned out not to have is one permutation.
    auto& all = plan_.permutations;
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.values < b.values; });
    all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.values == b.values; }),
              all.end());
    if (Status status = check_keys(); !status) return tl::unexpected(status.error());
    return std::move(plan_);
  }

 private:
  std::vector<std::string> stages() const {
    const std::size_t axis = builder_.index_of(AxisKind::stage);
    return axis < axes_.size() ? axes_[axis].archive.values : std::vector<std::string>{"surface"};
  }

  Status add_stage(const std::string& name) {
    const Result<const StageDescriptor*> stage = registry_.stage(name);
    if (!stage) return tl::unexpected(stage.error());
    const std::vector<std::size_t> techniques = builder_.technique_axes(**stage);
    if (!techniques.empty() && techniques.back() == axes_.size()) {
      return fail(ErrorCode::descriptor, "permute.no-technique",
                  fmt::format("stage '{}' traces, and the manifest has no axis \"technique\"", name));
    }
    std::vector<std::uint16_t> head(axes_.size(), kNoValue);
    const std::size_t axis = builder_.index_of(AxisKind::stage);
    if (axis < axes_.size()) {
      const auto& values = axes_[axis].archive.values;
      head[axis] = static_cast<std::uint16_t>(std::find(values.begin(), values.end(), name) - values.begin());
    }
    return count_through(head, techniques, [&] { return add_head(head); });
  }

  /// Calls `visit` with every combination of the values of `axes` in `values`, the last axis fastest.
  template <class Visit>
  Status count_through(std::vector<std::uint16_t>& values, const std::vector<std::size_t>& axes, const Visit& visit) {
    for (const std::size_t axis : axes) values[axis] = 0;
    for (;;) {
      if (Status status = visit(); !status) return status;
      std::size_t at = axes.size();
      while (at > 0 && ++values[axes[at - 1]] == axes_[axes[at - 1]].archive.values.size()) values[axes[--at]] = 0;
      if (at == 0) return {};
    }
  }

  Status add_head(std::vector<std::uint16_t> values) {
    std::vector<std::uint16_t> head = values;
    const Result<Permutation> permutation = builder_.build(head);
    if (!permutation) return tl::unexpected(permutation.error());
    std::vector<std::size_t> body;
    double combinations = 1;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const AxisKind kind = axes_[i].kind;
      const bool is_head = kind == AxisKind::technique || kind == AxisKind::role || kind == AxisKind::stage;
      if (is_head || !builder_.may_have(axes_[i], *permutation)) continue;
      body.push_back(i);
      combinations *= static_cast<double>(axes_[i].archive.values.size());
    }
    if (only_counts_) counted_ += combinations;
    if (counted_ > most_permutations) {
      return fail(
          ErrorCode::descriptor, "permute.too-many",
          fmt::format("the axes combine to more than {} permutations; fewer values are expected", most_permutations));
    }
    if (only_counts_) return {};
    return count_through(values, body, [&] { return add_one(values); });
  }

  Status add_one(const std::vector<std::uint16_t>& values) {
    PlannedPermutation planned;
    planned.values = values;
    const Result<Permutation> permutation = builder_.build(planned.values);
    if (!permutation) return tl::unexpected(permutation.error());
    const Result<Parts> parts = resolve(registry_, *permutation);
    if (!parts) return tl::unexpected(parts.error());
    for (const std::string& reason : pruner_.reasons(*parts, *permutation)) planned.pruned.push_back(number(reason));
    planned.key = key_of(planned.values);
    plan_.permutations.push_back(std::move(planned));
    return {};
  }

  Error in_manifest(Error error) const {
    if (!error.file.empty()) return error;
    error.file = manifest_.file;
    error.line = error.column = 1;
    return error;
  }

  std::uint32_t number(const std::string& reason) {
    if (reason.empty()) return 0;
    const auto [entry, is_new] = reasons_.try_emplace(reason, static_cast<std::uint32_t>(plan_.reasons.size() + 1));
    if (is_new) plan_.reasons.push_back(reason);
    return entry->second;
  }

  std::uint64_t key_of(const std::vector<std::uint16_t>& values) const {
    std::uint64_t key = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const ArchiveAxis& axis = plan_.axes[i];
      if (values[i] == kNoValue || values[i] == axis.default_value) continue;
      key += axis_key(axis.name, axis.values[values[i]]);
    }
    return key;
  }

  /// Also where a permutation without an axis meets the one at the axis's default.
  Status check_keys() const {
    std::unordered_map<std::uint64_t, const PlannedPermutation*> known;
    for (const PlannedPermutation& planned : plan_.permutations) {
      const auto [other, is_new] = known.try_emplace(planned.key, &planned);
      if (is_new) continue;
      return fail(ErrorCode::descriptor, "permute.key-collision",
                  fmt::format("the permutations '{}' and '{}' have one key; another name or default for an axis in "
                              "which they differ is expected",
                              plan_.name(*other->second), plan_.name(planned)),
                  manifest_.file, 1, 1);
    }
    return {};
  }

  const Registry& registry_;
  const Manifest& manifest_;
  std::vector<ResolvedAxis> axes_;
  PermutationBuilder builder_;
  Pruner pruner_;
  PermutationPlan plan_;
  std::unordered_map<std::string, std::uint32_t> reasons_;
  bool only_counts_ = false;
  double counted_ = 0;  ///< combinations of all heads
};

}  // namespace

bool PlannedPermutation::is_kept() const {
  return std::find(pruned.begin(), pruned.end(), 0u) != pruned.end();
}

std::string PermutationPlan::name(const PlannedPermutation& permutation) const {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::uint16_t value = permutation.values[i];
    if (value != kNoValue) words.push_back(fmt::format("{}={}", axes[i].name, axes[i].values[value]));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

Result<PermutationPlan> plan_permutations(const Registry& registry, const Manifest& manifest) {
  Result<std::vector<ResolvedAxis>> axes = resolve_axes(registry, manifest);
  if (!axes) return tl::unexpected(axes.error());
  if (Status status = check_rules(registry, manifest); !status) return tl::unexpected(status.error());
  return Planner(registry, manifest, *std::move(axes)).run();
}

Result<Permutation> to_permutation(const Registry& registry, const Manifest& manifest, const PermutationPlan&,
                                   const PlannedPermutation& planned) {
  const Result<std::vector<ResolvedAxis>> axes = resolve_axes(registry, manifest);
  if (!axes) return tl::unexpected(axes.error());
  std::vector<std::uint16_t> values = planned.values;
  return PermutationBuilder(registry, *axes).build(values);
}

}  // namespace relievo
