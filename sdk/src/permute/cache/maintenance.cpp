/// What `relievo cache` does to a folder that other processes may be using.
#include <fmt/format.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "permute/cache/entry_file.hpp"
#include "permute/cache/folder.hpp"
#include "permute/cache/usage.hpp"
#include "relievo/cache.hpp"

namespace relievo {

namespace {

std::uint64_t count_dead(const cache::FolderListing& listing) {
  std::uint64_t dead = 0;
  for (const cache::TemporaryFile& file : listing.temporaries) dead += file.dead ? 1 : 0;
  return dead;
}

tl::unexpected<Error> not_removed(const std::string& path, int reason) {
  return fail(ErrorCode::io, "cache.folder", fmt::format("an entry cannot be removed: {}", std::strerror(reason)),
              path);
}

}  // namespace

Result<CacheContents> inspect_cache(const std::filesystem::path& folder) {
  const auto listing = cache::list_folder(folder.string());
  if (!listing) return tl::unexpected(listing.error());
  CacheContents contents;
  contents.entries = listing->entries.size();
  for (const cache::EntryFile& file : listing->entries) contents.bytes += file.bytes;
  contents.unfinished = count_dead(*listing);
  return contents;
}

Result<CacheContents> verify_cache(const std::filesystem::path& folder) {
  const auto listing = cache::list_folder(folder.string());
  if (!listing) return tl::unexpected(listing.error());
  CacheContents contents;
  contents.unfinished = count_dead(*listing);
  for (const cache::EntryFile& file : listing->entries) {
    using State = cache::EntryRead::State;
    const State state = read_entry_file(cache::entry_path(folder.string(), file.key), file.key, cache::Touch::no).state;
    if (state == State::sound) {
      ++contents.entries;
      contents.bytes += file.bytes;
    } else if (state == State::unreadable) {
      ++contents.unreadable;
    } else if (state != State::absent) {
      ++contents.broken;
    }
  }
  return contents;
}

Result<CacheContents> clear_cache(const std::filesystem::path& folder) {
  // Locked, so that what others book meanwhile is not counted before and forgotten after.
  const auto file = cache::UsageFile::lock(folder.string(), cache::UsageFile::Absent::leave);
  const auto listing = cache::list_folder(folder.string());
  if (!listing) return tl::unexpected(listing.error());
  CacheContents removed;
  for (const cache::EntryFile& entry : listing->entries) {
    const std::string path = cache::entry_path(folder.string(), entry.key);
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) return not_removed(path, errno);
    ++removed.entries;
    removed.bytes += entry.bytes;
  }
  removed.unfinished = cache::sweep_dead(listing->temporaries);
  if (file) file->write({0, cache::new_generation()});
  return removed;
}

}  // namespace relievo
