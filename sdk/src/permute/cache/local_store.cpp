#include "permute/cache/local_store.hpp"

#include <fmt/format.h>
#include <cstring>

#include "permute/cache/entry_file.hpp"
#include "permute/cache/folder.hpp"

namespace relievo::cache {

LocalStore::LocalStore(std::string folder, std::uint64_t max_bytes, Events& events)
    : folder_(std::move(folder)), events_(events), bound_(folder_, max_bytes) {}

std::optional<std::string> LocalStore::load(const CacheKey& key) {
  const std::string path = entry_path(folder_, key);
  EntryRead read = read_entry_file(path, key, Touch::yes);
  switch (read.state) {
    case EntryRead::State::sound:
      return std::move(read.payload);
    case EntryRead::State::damaged:
      ++events_.broken;
      events_.say(fmt::format("the cache entry '{}' is damaged and is removed: {}", path, read.fault));
      return std::nullopt;
    case EntryRead::State::unreadable:
      events_.say(fmt::format("the cache entry '{}' is passed over: {}", path, read.fault));
      return std::nullopt;
    case EntryRead::State::absent:
      break;
  }
  return std::nullopt;
}

bool LocalStore::store(const CacheKey& key, std::string_view header, std::string_view payload) {
  const std::uint64_t bytes = header.size() + payload.size();
  if (payload.size() > kMaxPayload || bytes > bound_.largest_entry())
    return store_failed(fmt::format("an entry has {} bytes; expected at most {}", bytes,
                                    std::min(kMaxPayload + kHeaderSize, bound_.largest_entry())));
  events_.evictions += bound_.book(bytes);
  const int failed = write_entry_file(entry_path(folder_, key), header, payload);
  if (failed == 0) return true;
  bound_.unbook(bytes);
  return store_failed(std::strerror(failed));
}

bool LocalStore::store_failed(std::string_view why) {
  ++events_.failed_stores;
  if (!said_that_storing_fails_.exchange(true))
    events_.say(fmt::format("the cache folder '{}' does not take an entry: {}; the run goes on without", folder_, why));
  return false;
}

}  // namespace relievo::cache
