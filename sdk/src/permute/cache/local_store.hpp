/// Entries in a folder of this machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "permute/cache/events.hpp"
#include "permute/cache/size_bound.hpp"

namespace relievo::cache {

/// Thread-safe. `events` must outlive it.
class LocalStore {
 public:
  LocalStore(std::string folder, std::uint64_t max_bytes, Events& events);

  std::optional<std::string> load(const CacheKey& key);
  /// False when it could not be kept, which is counted, and said the first time.
  bool store(const CacheKey& key, std::string_view header, std::string_view payload);

 private:
  bool store_failed(std::string_view why);

  const std::string folder_;
  Events& events_;
  SizeBound bound_;
  std::atomic<bool> said_that_storing_fails_ = false;
};

}  // namespace relievo::cache
