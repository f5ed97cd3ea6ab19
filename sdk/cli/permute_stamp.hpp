/// What a run leaves beside its archive, by which a later one knows that there is nothing to do.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/permute.hpp"

namespace relievo::cli {

/// What decides an archive's bytes, hashed.
struct Fingerprint {
  std::string plan;   ///< program version, manifest and sources: the same for all shards
  std::string shard;  ///< which of them it is, and the costs that divide them
  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

/// `manifest` is the text that was there before it was parsed: what is edited meanwhile then counts as a change.
Fingerprint fingerprint(std::string_view manifest, const Registry& registry, std::string_view shard,
                        std::string_view costs);

struct Stamp {
  Fingerprint made_from;
  std::string archive;             ///< the archive's size and time when it was finished
  std::vector<std::string> files;  ///< the sources that were read, for depfiles
};

/// Nothing where there is no stamp, or none that is whole.
std::optional<Stamp> read_stamp(const std::string& path);
Status write_stamp(const std::string& path, const std::string& archive, const Fingerprint& made_from,
                   const std::vector<std::string>& files);

/// The archive is sound, has not changed since it was stamped, and was made from the same.
bool is_up_to_date(const Stamp& stamp, const std::string& archive, const Fingerprint& now);

/// "out/cliffs.rla" → "out/cliffs.stamp"
std::string stamp_path(const std::string& archive);

}  // namespace relievo::cli
