/// The archives of all shards, made one.
#pragma once

#include <string>
#include <vector>

#include "permute_stamp.hpp"

namespace relievo::cli {

/// Writes `path` when the parts are those of this plan, and all of them; otherwise leaves it as it was.
/// Errors: "permute.mixed" for a part of another plan, "permute.incomplete", and those of `merge_archives`.
Status merge_shards(const PermutationPlan& plan, const Fingerprint& now, const std::vector<std::string>& parts,
                    const std::string& path);

}  // namespace relievo::cli
