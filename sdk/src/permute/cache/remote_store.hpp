/// Entries in a Redis server that several machines share.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "permute/cache/events.hpp"
#include "permute/cache/redis_connection.hpp"

namespace relievo::cache {

/// Thread-safe: each thread that waits for an answer has a connection of its own; one more thread stores. The first
/// trouble is said and ends all traffic. `events` must outlive it.
class RemoteStore {
 public:
  RemoteStore(RemoteAddress address, std::string name, std::chrono::milliseconds timeout, Events& events);
  /// Waits for what is still to be stored: at most ten timeouts.
  ~RemoteStore();
  RemoteStore(const RemoteStore&) = delete;
  RemoteStore& operator=(const RemoteStore&) = delete;

  /// The bytes of an entry, unchecked.
  std::optional<std::string> load(const CacheKey& key);
  /// Returns before it is stored, unless a lot is waiting; then after at most one timeout.
  void store(const CacheKey& key, std::string_view header, std::string_view payload);
  void remove(const CacheKey& key);

 private:
  struct Waiting {
    CacheKey key;
    std::string bytes;
  };

  std::optional<RedisReply> ask(const std::vector<std::string_view>& words);
  std::optional<RedisReply> ask_to_change(const std::vector<std::string_view>& words);
  tl::expected<RedisConnection, RedisTrouble> idle_or_new(bool& fresh, Deadline deadline);
  void keep(RedisConnection connection);
  void turn_off(const std::string& why);
  void store_waiting();

  const RemoteAddress address_;
  const std::string name_;
  const std::chrono::milliseconds timeout_;
  Events& events_;
  std::atomic<bool> off_ = false, read_only_ = false;

  std::mutex idle_mutex_;
  std::vector<RedisConnection> idle_;

  std::mutex queue_mutex_;
  std::condition_variable queue_changed_;
  std::deque<Waiting> queue_;
  std::size_t queued_bytes_ = 0;
  bool busy_ = false, closing_ = false;
  std::thread writer_;
};

}  // namespace relievo::cache
