#include "describe/toml_nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace relievo {
namespace {

constexpr int max_dots = 15;
constexpr int max_brackets = 16;

/// The position after the string that starts at `start`: basic or literal, of one or of many lines. A string that is
/// not closed ends where toml++ stops with an error.
std::size_t skip_string(std::string_view text, std::size_t start) {
  const char mark = text[start];
  const bool long_string = text.substr(start, 3) == std::string(3, mark);
  std::size_t at = start + (long_string ? 3 : 1);
  while (at < text.size()) {
    if (mark == '"' && text[at] == '\\') {
      at += 2;
    } else if (long_string && text.substr(at, 3) == std::string(3, mark)) {
      at += 3;
      while (at < text.size() && text[at] == mark) ++at;  // up to two marks may end the content
      return at;
    } else if (!long_string && (text[at] == mark || text[at] == '\n')) {
      return at + 1;
    } else {
      ++at;
    }
  }
  return text.size();
}

tl::unexpected<Error> too_deep(std::string_view text, std::size_t at, const std::string& file, const char* what) {
  const std::string_view before = text.substr(0, at);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fail(ErrorCode::descriptor, "describe.syntax", fmt::format("{} at most 16 are allowed", what), file,
              static_cast<int>(line), static_cast<int>(at - line_start + 1));
}

}  // namespace

Status check_toml_nesting(std::string_view text, const std::string& file) {
  int dots = 0, brackets = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = skip_string(text, at);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '.' && ++dots > max_dots) return too_deep(text, at, file, "a dotted key has more than 16 parts;");
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots = 0;
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
    if (brackets > max_brackets) return too_deep(text, at, file, "brackets nest more than 16 deep;");
    ++at;
  }
  return {};
}

}  // namespace relievo
