#include "permute_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

namespace relievo::cli {

namespace {

using ByKey = std::unordered_map<std::uint64_t, const PlannedPermutation*>;

tl::unexpected<Error> mixed(const std::string& part, const std::string& what) {
  return fail(ErrorCode::usage, "permute.mixed", fmt::format("the part '{}' {}; run its shard again", part, what),
              part);
}

/// By target, why the permutation cannot have it; empty where it has.
using Reasons = std::map<std::string, std::string, std::less<>>;

Reasons planned_reasons(const PermutationPlan& plan, const PlannedPermutation& planned) {
  Reasons reasons;
  for (std::size_t i = 0; i < plan.targets.size(); ++i)
    reasons[to_string(plan.targets[i])] = planned.pruned[i] == 0 ? "" : plan.reasons[planned.pruned[i] - 1];
  return reasons;
}

Reasons archived_reasons(const Archive& part, Archive::Entry entry) {
  Reasons reasons;
  for (const ArchiveOutput& output : part.outputs(entry)) reasons[to_string(output.target)] = "";
  for (const auto& [target, reason] : part.absent(entry)) reasons[to_string(target)] = reason;
  return reasons;
}

/// Removes from `missing` what the part has.
Status take_part(const PermutationPlan& plan, const Fingerprint& now, const std::string& path, const ByKey& kept,
                 std::set<std::uint64_t>& missing) {
  const std::optional<Stamp> stamp = read_stamp(stamp_path(path));
  if (stamp && stamp->made_from.plan != now.plan)
    return mixed(path, "was made from another manifest, other techniques or by another version of relievo");
  const Result<Archive> part = Archive::open(path);
  if (!part) return tl::unexpected(part.error());
  if (part->axes() != plan.axes) return mixed(path, "has other axes than the manifest");
  for (Archive::Entry entry = 0; entry < part->size(); ++entry) {
    const auto planned = kept.find(part->key(entry));
    if (planned == kept.end())
      return mixed(path, fmt::format("has the permutation {}, which the manifest has not", part->name(entry)));
    if (archived_reasons(*part, entry) != planned_reasons(plan, *planned->second))
      return mixed(path, fmt::format("has the permutation {} for other targets than the manifest", part->name(entry)));
    missing.erase(part->key(entry));
  }
  return {};
}

}  // namespace

Status merge_shards(const PermutationPlan& plan, const Fingerprint& now, const std::vector<std::string>& parts,
                    const std::string& path) {
  ByKey kept;
  std::set<std::uint64_t> missing;
  for (const PlannedPermutation& planned : plan.permutations) {
    if (!planned.is_kept()) continue;
    kept.emplace(planned.key, &planned);
    missing.insert(planned.key);
  }
  for (const std::string& part : parts) {
    if (Status status = take_part(plan, now, part, kept, missing); !status) return status;
  }
  if (missing.empty()) return merge_archives(std::vector<std::filesystem::path>(parts.begin(), parts.end()), path);
  const auto first = std::find_if(plan.permutations.begin(), plan.permutations.end(),
                                  [&](const PlannedPermutation& planned) { return missing.contains(planned.key); });
  return fail(ErrorCode::usage, "permute.incomplete",
              fmt::format("the parts lack {} of {} permutations, the first of them {}; every shard of one plan is "
                          "expected",
                          missing.size(), kept.size(), plan.name(*first)));
}

}  // namespace relievo::cli
