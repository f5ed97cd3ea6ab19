#include "permute/cache/size_bound.hpp"

#include <unistd.h>
#include <algorithm>
#include <tuple>
#include <utility>

#include "permute/cache/folder.hpp"

namespace relievo::cache {

namespace {

struct Eviction {
  std::uint64_t bytes_left = 0, evicted = 0;
};

/// Removes entries, oldest first, until at most `bytes` are left.
Eviction evict_down_to(const std::string& folder, std::uint64_t bytes) {
  Result<FolderListing> listing = list_folder(folder);
  if (!listing) return {bytes, 0};  // unknown, but soon counted anew
  sweep_dead(listing->temporaries);
  Eviction result;
  for (const EntryFile& file : listing->entries) result.bytes_left += file.bytes;
  if (result.bytes_left <= bytes) return result;
  std::sort(listing->entries.begin(), listing->entries.end(),
            [](const EntryFile& a, const EntryFile& b) { return std::tie(a.used, a.key) < std::tie(b.used, b.key); });
  for (const EntryFile& file : listing->entries) {
    if (result.bytes_left <= bytes) break;
    if (::unlink(entry_path(folder, file.key).c_str()) != 0) continue;
    result.bytes_left -= file.bytes;
    ++result.evicted;
  }
  return result;
}

}  // namespace

SizeBound::SizeBound(std::string folder, std::uint64_t max_bytes) : folder_(std::move(folder)), max_bytes_(max_bytes) {}

SizeBound::~SizeBound() {
  if (booked_ == 0) return;
  const auto file = UsageFile::lock(folder_, UsageFile::Absent::leave, patience_);
  if (!file) return;
  auto usage = file->read();
  if (!usage || usage->generation != generation_) return;
  usage->bytes -= std::min(usage->bytes, booked_);
  file->write(*usage);
}

std::uint64_t SizeBound::book(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t evicted = booked_ < bytes ? book_batch(bytes) : 0;
  booked_ -= bytes;
  return evicted;
}

void SizeBound::unbook(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  booked_ += bytes;
}

std::uint64_t SizeBound::book_batch(std::uint64_t bytes) {
  const std::uint64_t batch = std::max(bytes, max_bytes_ / 128);
  const auto file = UsageFile::lock(folder_, UsageFile::Absent::make, patience_);
  if (!file) {
    patience_ = std::chrono::milliseconds(0);
    generation_ = 0;  // nothing was booked, so nothing is to be given back
    booked_ += batch;
    return 0;
  }
  std::optional<Usage> usage = file->read();
  if (!usage || usage->generation != generation_) booked_ = 0;
  // Other processes may each have a batch that a new count does not know: an eighth is left for them.
  const std::uint64_t full = max_bytes_ - max_bytes_ / 8;
  Eviction eviction;
  if (!usage || usage->bytes + batch > full) {
    eviction = evict_down_to(folder_, std::min(max_bytes_ / 5 * 4, full - batch));
    usage = Usage{eviction.bytes_left, new_generation()};
  }
  usage->bytes += batch;
  file->write(*usage);
  generation_ = usage->generation;
  booked_ += batch;
  return eviction.evicted;
}

}  // namespace relievo::cache
