#include "permute/cache/remote_address.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <optional>

namespace relievo::cache {

namespace {

std::optional<int> parse_number(std::string_view text, int lowest, int highest) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (value < lowest || value > highest) return std::nullopt;
  return value;
}

bool is_host_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' || c == '_';
}

/// Takes the host off the front of `text`; an IPv6 address stands in brackets.
std::string take_host(std::string_view& text) {
  const bool bracketed = text.starts_with('[');
  const std::size_t end = bracketed ? text.find(']') : text.find(':');
  if (bracketed && end == std::string_view::npos) return {};
  const std::string_view host = bracketed ? text.substr(1, end - 1) : text.substr(0, end);
  text.remove_prefix(bracketed ? end + 1 : host.size());
  const bool allowed = std::all_of(
      host.begin(), host.end(), [&](char c) { return is_host_character(c) || (bracketed && (c == ':' || c == '%')); });
  return allowed ? std::string(host) : std::string();
}

std::optional<RemoteAddress> parse(std::string_view text) {
  constexpr std::string_view scheme = "redis://";
  if (!text.starts_with(scheme)) return std::nullopt;
  text.remove_prefix(scheme.size());
  RemoteAddress address;
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    const auto database = parse_number(text.substr(slash + 1), 0, 1'000'000);
    if (!database && slash + 1 != text.size()) return std::nullopt;
    address.database = database.value_or(0);
    text = text.substr(0, slash);
  }
  address.host = take_host(text);
  if (address.host.empty()) return std::nullopt;
  if (text.empty()) return address;
  const auto port = text.front() == ':' ? parse_number(text.substr(1), 1, 65535) : std::nullopt;
  if (!port) return std::nullopt;
  address.port = *port;
  return address;
}

}  // namespace

Result<RemoteAddress> parse_remote_address(std::string_view text) {
  if (auto address = parse(text)) return *std::move(address);
  return fail(ErrorCode::usage, "cache.remote",
              fmt::format("the remote cache's address is '{}'; expected redis://host[:port][/database]", text));
}

}  // namespace relievo::cache
