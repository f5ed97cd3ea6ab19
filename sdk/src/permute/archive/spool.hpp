/// Blobs on disk until an archive is written: equal ones once, memory only for their hashes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "files/file_beside.hpp"
#include "permute/archive/format.hpp"
#include "relievo/result.hpp"

namespace relievo::archive {

/// Equal for equal contents; different ones share one by chance at 2⁻¹²⁸.
struct ContentHash {
  std::uint64_t low = 0, high = 0;
  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};
ContentHash content_hash(std::string_view bytes);
struct ContentHasher {
  std::size_t operator()(const ContentHash& hash) const { return static_cast<std::size_t>(hash.low); }
};

struct SpooledBlob {
  std::uint64_t offset = 0;  ///< in the spool file; a multiple of 8
  std::uint64_t size = 0;    ///< bytes
  std::uint64_t hash = 0;    ///< as in BlobRecord
};

/// "'a.rva' cannot be written: No space left on device [archive.write]", from errno.
tl::unexpected<Error> write_failure(const std::filesystem::path& path);

/// Not thread-safe.
class Spool {
 public:
  /// Opens a file beside `path` that vanishes with the process, however that ends. Errors: "archive.write".
  static Result<Spool> create(const std::filesystem::path& path);

  /// The number of a blob that equals `bytes`. Errors: "archive.write".
  Result<std::uint32_t> add(std::string_view bytes, const ContentHash& hash);

  const std::vector<SpooledBlob>& blobs() const { return blobs_; }
  const files::File& file() const { return file_; }
  /// Whether `files::give_name` works on this file system.
  bool can_be_named() const { return can_be_named_; }

 private:
  std::filesystem::path path_;
  files::File file_;
  std::vector<SpooledBlob> blobs_;
  std::unordered_map<ContentHash, std::uint32_t, ContentHasher> numbers_;
  std::uint64_t end_ = sizeof(Header);  ///< so that the spool may become the archive
  bool can_be_named_ = false;
};

}  // namespace relievo::archive
