#include "permute/cache/remote_store.hpp"

#include <fmt/format.h>
#include <system_error>

namespace relievo::cache {

namespace {

constexpr std::size_t kMaxQueuedBytes = 16 << 20;
constexpr int kTimeoutsToClose = 10;

/// The 1 is the version of this naming; entries have their own.
std::string name_of(const CacheKey& key) {
  return "relievo:1:" + to_string(key);
}

}  // namespace

RemoteStore::RemoteStore(RemoteAddress address, std::string name, std::chrono::milliseconds timeout, Events& events)
    : address_(std::move(address)), name_(std::move(name)), timeout_(timeout), events_(events) {
  auto connection = RedisConnection::open(address_, std::chrono::steady_clock::now() + timeout_);
  if (connection) {
    keep(*std::move(connection));
  } else {
    turn_off(connection.error().what);
  }
}

RemoteStore::~RemoteStore() {
  std::size_t lost = 0;
  {
    std::unique_lock lock(queue_mutex_);
    closing_ = true;
    queue_changed_.notify_all();
    queue_changed_.wait_for(lock, kTimeoutsToClose * timeout_,
                            [&] { return off_ || read_only_ || (queue_.empty() && !busy_); });
    lost = off_ || read_only_ ? 0 : queue_.size();
    queue_.clear();
  }
  if (lost > 0) events_.say(fmt::format("the remote cache {} is slow: {} entries are not stored there", name_, lost));
  if (writer_.joinable()) writer_.join();
}

std::optional<std::string> RemoteStore::load(const CacheKey& key) {
  const std::string name = name_of(key);
  const auto reply = ask({"GET", name});
  if (!reply || (*reply)->type == REDIS_REPLY_NIL) return std::nullopt;
  if ((*reply)->type == REDIS_REPLY_STRING) return std::string((*reply)->str, (*reply)->len);
  turn_off((*reply)->type == REDIS_REPLY_ERROR ? fmt::format("it answers '{}'", (*reply)->str)
                                               : "its answer is no value");
  return std::nullopt;
}

void RemoteStore::store(const CacheKey& key, std::string_view header, std::string_view payload) {
  if (off_ || read_only_) return;
  std::string bytes;
  bytes.reserve(header.size() + payload.size());
  bytes.append(header).append(payload);
  std::unique_lock lock(queue_mutex_);
  const bool has_room = queue_changed_.wait_for(lock, timeout_, [&] {
    return off_ || read_only_ || queue_.empty() || queued_bytes_ + bytes.size() <= kMaxQueuedBytes;
  });
  if (off_ || read_only_) return;
  if (has_room) {
    queued_bytes_ += bytes.size();
    queue_.push_back({key, std::move(bytes)});
    queue_changed_.notify_all();
  }
  std::string failed;
  try {
    if (!writer_.joinable()) writer_ = std::thread([this] { store_waiting(); });
  } catch (const std::system_error& error) {
    failed = fmt::format("no thread can be started to write to it: {}", error.what());
  }
  lock.unlock();
  if (!has_room) turn_off("it does not take entries in time");
  if (!failed.empty()) turn_off(failed);
}

void RemoteStore::remove(const CacheKey& key) {
  const std::string name = name_of(key);
  ask_to_change({"DEL", name});
}

void RemoteStore::store_waiting() {
  std::unique_lock lock(queue_mutex_);
  while (true) {
    queue_changed_.wait(lock, [&] { return closing_ || off_ || read_only_ || !queue_.empty(); });
    if (off_ || read_only_ || queue_.empty()) break;
    const Waiting next = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= next.bytes.size();
    busy_ = true;
    lock.unlock();
    const std::string name = name_of(next.key);
    ask_to_change({"SET", name, next.bytes});
    lock.lock();
    busy_ = false;
    queue_changed_.notify_all();
  }
  queue_.clear();
  queued_bytes_ = 0;
  queue_changed_.notify_all();
}

/// A server that refuses a change (full, or a replica) may still be read.
std::optional<RedisReply> RemoteStore::ask_to_change(const std::vector<std::string_view>& words) {
  if (read_only_) return std::nullopt;
  auto reply = ask(words);
  if (reply && (*reply)->type == REDIS_REPLY_ERROR && !read_only_.exchange(true))
    events_.say(fmt::format("the remote cache {} is only read from now on: it answers '{}'", name_, (*reply)->str));
  return reply;
}

std::optional<RedisReply> RemoteStore::ask(const std::vector<std::string_view>& words) {
  const Deadline deadline = std::chrono::steady_clock::now() + timeout_;
  // Again where an idle connection turns out to be closed: a server may do so, and it may have been started anew.
  for (bool fresh = false; !off_;) {
    auto connection = idle_or_new(fresh, deadline);
    if (!connection) {
      turn_off(connection.error().what);
      break;
    }
    auto reply = connection->ask(words, deadline);
    if (reply) {
      keep(*std::move(connection));
      return *std::move(reply);
    }
    if (fresh || !reply.error().closed) turn_off(reply.error().what);
  }
  return std::nullopt;
}

tl::expected<RedisConnection, RedisTrouble> RemoteStore::idle_or_new(bool& fresh, Deadline deadline) {
  {
    const std::lock_guard lock(idle_mutex_);
    if (!idle_.empty()) {
      RedisConnection connection = std::move(idle_.back());
      idle_.pop_back();
      return connection;
    }
  }
  fresh = true;
  return RedisConnection::open(address_, deadline);
}

void RemoteStore::keep(RedisConnection connection) {
  const std::lock_guard lock(idle_mutex_);
  idle_.push_back(std::move(connection));
}

void RemoteStore::turn_off(const std::string& why) {
  if (off_.exchange(true)) return;
  events_.say(fmt::format("the remote cache {} is not used any more: {}; the local folder serves alone", name_, why));
  const std::lock_guard lock(queue_mutex_);
  queue_changed_.notify_all();
}

}  // namespace relievo::cache
