/// What a cache says and counts. Safe for any number of threads.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string_view>
#include <utility>

#include "relievo/cache.hpp"

namespace relievo::cache {

class Events {
 public:
  explicit Events(std::function<void(std::string_view)> log) : log_(std::move(log)) {}

  /// One caller at a time, so that the user's function needs no lock.
  void say(std::string_view sentence) {
    if (!log_) return;
    const std::lock_guard lock(mutex_);
    log_(sentence);
  }

  CacheCounts counts() const { return {hits, remote_hits, misses, stores, evictions, broken, failed_stores}; }

  std::atomic<std::uint64_t> hits = 0, remote_hits = 0, misses = 0, stores = 0, evictions = 0, broken = 0,
                             failed_stores = 0;

 private:
  std::function<void(std::string_view)> log_;
  std::mutex mutex_;
};

}  // namespace relievo::cache
