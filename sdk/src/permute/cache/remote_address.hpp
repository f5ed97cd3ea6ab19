/// Where a remote cache is: "redis://host[:port][/database]".
#pragma once

#include <string>
#include <string_view>

#include "relievo/result.hpp"

namespace relievo::cache {

struct RemoteAddress {
  std::string host;  ///< a name, or an IPv4 or IPv6 address without brackets
  int port = 6379;
  int database = 0;
};

/// Errors: "cache.remote".
Result<RemoteAddress> parse_remote_address(std::string_view text);

}  // namespace relievo::cache
