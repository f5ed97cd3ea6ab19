/// One connection to Redis. hiredis connects, formats and parses; sending and receiving is done here, for its own has
/// no deadline over a whole answer, and raises SIGPIPE when the server is gone.
#pragma once

#include <hiredis/hiredis.h>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "permute/cache/remote_address.hpp"

namespace relievo::cache {

using Deadline = std::chrono::steady_clock::time_point;
using RedisReply = std::unique_ptr<redisReply, decltype(&freeReplyObject)>;

/// Why there is no answer. `closed`: the server ended the connection, as it may do with an idle one.
struct RedisTrouble {
  std::string what;
  bool closed = false;
};

class RedisConnection {
 public:
  /// Resolves the host, connects, and selects the database, all before the deadline.
  static tl::expected<RedisConnection, RedisTrouble> open(const RemoteAddress& address, Deadline deadline);

  /// The answer, which may be an error of the server. After trouble the connection is of no more use.
  tl::expected<RedisReply, RedisTrouble> ask(const std::vector<std::string_view>& words, Deadline deadline);

 private:
  using Context = std::shared_ptr<redisContext>;  // the thread that connects may end after we have given up
  explicit RedisConnection(Context context) : context_(std::move(context)) {}

  tl::expected<void, RedisTrouble> send(std::string_view bytes, Deadline deadline);
  tl::expected<RedisReply, RedisTrouble> receive(Deadline deadline);

  Context context_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 17);
};

}  // namespace relievo::cache
