#include <list>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "relievo/cache.hpp"

namespace relievo {

namespace {

class MemoryCache final : public Cache {
 public:
  explicit MemoryCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  std::optional<std::string> load(const CacheKey& key) override {
    const std::lock_guard lock(guard_);
    const auto found = places_.find(key);
    if (found == places_.end()) {
      ++counts_.misses;
      return std::nullopt;
    }
    ++counts_.hits;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->payload;
  }

  void store(const CacheKey& key, std::string_view payload) override {
    const std::lock_guard lock(guard_);
    if (payload.size() > max_bytes_) return;
    if (const auto found = places_.find(key); found != places_.end()) drop(found->second);
    entries_.push_front({key, std::string(payload)});
    places_[key] = entries_.begin();
    bytes_ += payload.size();
    ++counts_.stores;
    for (; bytes_ > max_bytes_; ++counts_.evictions) drop(std::prev(entries_.end()));
  }

  CacheCounts counts() const override {
    const std::lock_guard lock(guard_);
    return counts_;
  }

 private:
  struct Entry {
    CacheKey key;
    std::string payload;
  };
  using Entries = std::list<Entry>;

  void drop(Entries::iterator entry) {
    bytes_ -= entry->payload.size();
    places_.erase(entry->key);
    entries_.erase(entry);
  }

  const std::uint64_t max_bytes_;
  mutable std::mutex guard_;
  Entries entries_;  // last used first
  std::map<CacheKey, Entries::iterator> places_;
  std::uint64_t bytes_ = 0;
  CacheCounts counts_;
};

}  // namespace

std::unique_ptr<Cache> make_memory_cache(std::uint64_t max_bytes) {
  return std::make_unique<MemoryCache>(max_bytes);
}

}  // namespace relievo
