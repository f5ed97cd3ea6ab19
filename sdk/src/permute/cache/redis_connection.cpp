#include "permute/cache/redis_connection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <future>
#include <system_error>
#include <thread>

#include "permute/cache/entry.hpp"

namespace relievo::cache {

namespace {

using std::chrono::milliseconds;

tl::unexpected<RedisTrouble> trouble(std::string what, bool closed = false) {
  return tl::unexpected(RedisTrouble{std::move(what), closed});
}

milliseconds left(Deadline deadline) {
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now()));
}

/// False at the deadline.
bool wait_for(int fd, short events, Deadline deadline) {
  while (true) {
    pollfd poll_fd{fd, events, 0};
    const int ready = ::poll(&poll_fd, 1, static_cast<int>(left(deadline).count()));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

/// In a thread of its own, because resolving a name knows no timeout. A thread that is late is left to itself.
std::shared_ptr<redisContext> connect(const RemoteAddress& address, Deadline deadline) {
  const milliseconds time = left(deadline);
  const timeval timeout{time.count() / 1000, time.count() % 1000 * 1000};
  std::packaged_task<std::shared_ptr<redisContext>()> task([address, timeout] {
    return std::shared_ptr<redisContext>(redisConnectWithTimeout(address.host.c_str(), address.port, timeout),
                                         [](redisContext* context) {
                                           if (context != nullptr) redisFree(context);
                                         });
  });
  auto connected = task.get_future();
  std::thread(std::move(task)).detach();
  if (connected.wait_until(deadline) != std::future_status::ready) return nullptr;
  return connected.get();
}

bool would_block(int reason) {
  return reason == EAGAIN || reason == EWOULDBLOCK;
}

bool connection_lost(int reason) {
  return reason == ECONNRESET || reason == EPIPE || reason == ENOTCONN;
}

}  // namespace

tl::expected<RedisConnection, RedisTrouble> RedisConnection::open(const RemoteAddress& address, Deadline deadline) {
  Context context;
  try {
    context = connect(address, deadline);
  } catch (const std::system_error& error) {
    return trouble(fmt::format("no thread can be started to connect: {}", error.what()));
  }
  if (!context) return trouble("it cannot be connected to in time");
  if (context->err != 0) return trouble(fmt::format("it cannot be connected to: {}", context->errstr));
  ::fcntl(context->fd, F_SETFD, FD_CLOEXEC);
  RedisConnection connection(std::move(context));
  const std::string database = std::to_string(address.database);
  const auto reply = connection.ask({"SELECT", database}, deadline);
  if (!reply) return tl::unexpected(reply.error());
  if ((*reply)->type == REDIS_REPLY_ERROR) return trouble(fmt::format("it answers '{}'", (*reply)->str));
  return connection;
}

tl::expected<RedisReply, RedisTrouble> RedisConnection::ask(const std::vector<std::string_view>& words,
                                                            Deadline deadline) {
  std::vector<const char*> starts;
  std::vector<std::size_t> sizes;
  for (const std::string_view word : words) {
    starts.push_back(word.data());
    sizes.push_back(word.size());
  }
  char* formatted = nullptr;
  const int size = redisFormatCommandArgv(&formatted, static_cast<int>(words.size()), starts.data(), sizes.data());
  if (size < 0) return trouble("no memory is left for a command");
  const std::unique_ptr<char, decltype(&redisFreeCommand)> command(formatted, &redisFreeCommand);
  if (auto sent = send({formatted, static_cast<std::size_t>(size)}, deadline); !sent)
    return tl::unexpected(sent.error());
  return receive(deadline);
}

tl::expected<void, RedisTrouble> RedisConnection::send(std::string_view bytes, Deadline deadline) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(context_->fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (would_block(errno)) {
      if (!wait_for(context_->fd, POLLOUT, deadline)) return trouble("it takes no data in time");
    } else if (errno != EINTR) {
      return trouble(fmt::format("it cannot be written to: {}", std::strerror(errno)), connection_lost(errno));
    }
  }
  return {};
}

tl::expected<RedisReply, RedisTrouble> RedisConnection::receive(Deadline deadline) {
  std::size_t total = 0;
  while (true) {
    const ssize_t got = ::recv(context_->fd, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (got == 0) return trouble("it closed the connection", true);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && would_block(errno)) {
      if (!wait_for(context_->fd, POLLIN, deadline)) return trouble("it does not answer in time");
      continue;
    }
    if (got < 0) return trouble(fmt::format("it cannot be read: {}", std::strerror(errno)), connection_lost(errno));
    // Nothing we ask is answered by a list, whose announced length alone makes hiredis allocate.
    if (total == 0 && buffer_[0] == '*') return trouble("it answers with a list; expected a value");
    total += static_cast<std::size_t>(got);
    if (total > 2 * kMaxPayload) return trouble("its answer has no end");
    void* reply = nullptr;
    if (redisReaderFeed(context_->reader, buffer_.data(), static_cast<std::size_t>(got)) != REDIS_OK ||
        redisReaderGetReply(context_->reader, &reply) != REDIS_OK)
      return trouble(fmt::format("its answer is not understood: {}", context_->reader->errstr));
    if (reply != nullptr) return RedisReply(static_cast<redisReply*>(reply), &freeReplyObject);
    // Data that keeps coming must end by the deadline as well.
    if (std::chrono::steady_clock::now() > deadline) return trouble("its answer does not end in time");
  }
}

}  // namespace relievo::cache
