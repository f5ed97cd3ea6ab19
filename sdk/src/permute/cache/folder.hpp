/// Where things lie in a cache folder:
///
///     ab/cdef….entry            the entry of key abcdef…: 2 and 30 hexadecimal digits
///     ab/cdef….PID-NUMBER.tmp   the same while process PID writes or removes it
///     usage                     the lock of whoever changes the count, and the count (usage.hpp)
#pragma once

#include <sys/types.h>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "relievo/cache.hpp"

namespace relievo::cache {

/// The folder as an absolute path, made and writable. Errors: "cache.folder".
Result<std::string> prepare_folder(const std::filesystem::path& given);

std::string entry_path(const std::string& folder, const CacheKey& key);
/// A name beside the entry that no other writer has.
std::string temporary_path(const std::string& entry_path);

struct EntryFile {
  CacheKey key;
  std::uint64_t bytes = 0;
  std::int64_t used = 0;  ///< ns since 1970
};

struct TemporaryFile {
  std::string path;
  bool dead = false;  ///< its writer is gone, or has had minutes
};

struct FolderListing {
  std::vector<EntryFile> entries;
  std::vector<TemporaryFile> temporaries;
};

/// Reads names and sizes; whatever has another name is left out. A folder that is absent is empty.
/// Errors: "cache.folder".
Result<FolderListing> list_folder(const std::string& folder);

/// Removes the unfinished files of dead writers; returns how many.
std::uint64_t sweep_dead(const std::vector<TemporaryFile>& temporaries);

}  // namespace relievo::cache
