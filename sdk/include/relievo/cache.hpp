/// A content-addressed store of compiled programs, on disk and shared between machines.
/// Every function here, and every function of a Cache but its destructor, is thread-safe, whatever other threads and
/// processes do with the same folder.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "relievo/result.hpp"

namespace relievo {

/// What an entry is found by: a 128-bit hash of everything that decides its payload.
struct CacheKey {
  std::uint64_t high = 0, low = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes what it is made of for null pointers
  friend auto operator<=>(const CacheKey&, const CacheKey&) = default;
};
/// 32 hexadecimal digits.
std::string to_string(const CacheKey& key);

/// Hashes the parts in order; ("ab", "c") and ("a", "bc") differ.
CacheKey cache_key(std::span<const std::string_view> parts);
inline CacheKey cache_key(std::initializer_list<std::string_view> parts) {
  return cache_key(std::span<const std::string_view>(parts.begin(), parts.size()));
}

struct CacheOptions {
  std::filesystem::path folder;                      ///< made when it is absent; empty: `default_cache_folder()`
  std::uint64_t max_bytes = std::uint64_t{1} << 31;  ///< beyond it the entries used longest ago go; at least 1 MiB
  std::string remote;                                ///< "redis://host[:port][/database]", or empty
  std::chrono::milliseconds remote_timeout{200};     ///< for connecting, and for every answer
  /// One sentence an event: a broken entry, an unreachable remote. Called from any thread, one at a time.
  std::function<void(std::string_view)> log;
};

/// $RELIEVO_CACHE_DIR, else $XDG_CACHE_HOME/relievo, else ~/.cache/relievo; empty when none of them is set.
std::filesystem::path default_cache_folder();

/// What a `Cache` did since it was opened.
struct CacheCounts {
  std::uint64_t hits = 0, remote_hits = 0, misses = 0, stores = 0, evictions = 0;
  std::uint64_t broken = 0;  ///< entries that did not hold what they promise; each was a miss and is gone
  std::uint64_t failed_stores = 0;
};

/// Safe for any number of threads, and of processes on one folder. A payload is stored whole or not at all: whatever
/// happens to a process or a file, `load` answers with the very bytes that were stored under the key, or with nothing.
class Cache {
 public:
  virtual ~Cache() = default;

  /// The payload, or nothing: an entry that is absent, truncated or damaged is a miss (logged when damaged).
  virtual std::optional<std::string> load(const CacheKey& key) = 0;
  /// Keeps the payload where that is possible; a full disk or a lost connection is logged, not an error.
  virtual void store(const CacheKey& key, std::string_view payload) = 0;
  virtual CacheCounts counts() const = 0;
};

/// Opens the folder, and the remote store behind it. A remote that cannot be reached, or that answers too slowly,
/// is logged once and not asked again. Errors: "cache.folder" when the folder cannot be made or written,
/// "cache.remote" for an address that is none, "cache.size".
Result<std::unique_ptr<Cache>> open_cache(const CacheOptions& options);

/// A cache that is gone with the process. Beyond `max_bytes` of payloads the entries used longest ago go; one that is
/// larger than that is not kept.
std::unique_ptr<Cache> make_memory_cache(std::uint64_t max_bytes);

/// What lies in a cache folder.
struct CacheContents {
  std::uint64_t entries = 0, bytes = 0;
  std::uint64_t broken = 0;      ///< counted by `verify_cache`
  std::uint64_t unreadable = 0;  ///< likewise: no permission, say; left as they are
  std::uint64_t unfinished = 0;  ///< files that writers left behind when they were stopped
};

/// Counts without reading payloads. A folder that is absent is empty. Errors: "cache.folder".
Result<CacheContents> inspect_cache(const std::filesystem::path& folder);
/// Reads every entry, and removes those that are damaged.
Result<CacheContents> verify_cache(const std::filesystem::path& folder);
/// Removes every entry and unfinished file, and nothing else that lies in the folder; says what was removed.
Result<CacheContents> clear_cache(const std::filesystem::path& folder);

}  // namespace relievo
