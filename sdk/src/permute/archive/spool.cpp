#include "permute/archive/spool.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cerrno>
#include <cstring>

#include "files/whole_file.hpp"
#include "permute/archive/format.hpp"

namespace relievo::archive {

ContentHash content_hash(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

tl::unexpected<Error> write_failure(const std::filesystem::path& path) {
  return file_error(path, "archive.write", fmt::format("cannot be written: {}", std::strerror(errno)));
}

Result<Spool> Spool::create(const std::filesystem::path& path) {
  Spool spool;
  spool.path_ = path;
  spool.file_ = files::create_unnamed(path, spool.can_be_named_);
  if (!spool.file_) return write_failure(path);
  return spool;
}

Result<std::uint32_t> Spool::add(std::string_view bytes, const ContentHash& hash) {
  if (const auto known = numbers_.find(hash); known != numbers_.end()) return known->second;
  if (!file_.write_at(end_, bytes)) return write_failure(path_);
  const auto number = static_cast<std::uint32_t>(blobs_.size());
  blobs_.push_back({end_, bytes.size(), hash64(bytes)});
  numbers_.emplace(hash, number);
  end_ = aligned(end_ + bytes.size());
  return number;
}

}  // namespace relievo::archive
