/// Whether an archive is what a run would write again.
#pragma once

#include <string>

#include "relievo/permute.hpp"

namespace relievo::cli {

/// The archive has not changed since it was stamped, nor has anything that it was made from.
bool is_up_to_date(const std::string& stamp, const std::string& archive, const Manifest& manifest,
                   const Registry& registry, const std::string& shard);

Status write_stamp(const std::string& stamp, const std::string& archive, const Manifest& manifest,
                   const Registry& registry, const std::string& shard);

}  // namespace relievo::cli
