#include "describe/toml_guard.hpp"

#include <algorithm>
#include <cstddef>

namespace relievo {
namespace {

constexpr int max_dots = 15;
constexpr int max_brackets = 16;

/// Lexes as TOML does, as far as strings, comments and brackets go. Where the text is not TOML it may go astray, but
/// toml++ stops there.
class TomlGuard {
 public:
  TomlGuard(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Status run() {
    while (status_ && at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string();
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        check(c);
        ++at_;
      }
    }
    return status_;
  }

 private:
  /// One character outside strings and comments.
  void check(char c) {
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots_ = 0;
    if (c == '.' && ++dots_ > max_dots) report("a dotted key has more than 16 parts; at most 16 are allowed");
    if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    if ((c == '[' || c == '{') && ++brackets_ > max_brackets) report("brackets nest more than 16 deep");
  }

  /// A basic or literal string, of one or of many lines.
  void skip_string() {
    const char mark = text_[at_];
    const std::string three(3, mark);
    const bool is_long = text_.substr(at_, 3) == three;
    at_ += is_long ? 3 : 1;
    while (at_ < text_.size()) {
      if (mark == '"' && text_[at_] == '\\') {
        at_ += 2;
      } else if (is_long && text_.substr(at_, 3) == three) {
        at_ += 3;
        while (at_ < text_.size() && text_[at_] == mark) ++at_;  // up to two marks may end the content
        return;
      } else if (!is_long && (text_[at_] == mark || text_[at_] == '\n')) {
        ++at_;
        return;
      } else {
        ++at_;
      }
    }
  }

  void report(const char* message) {
    if (!status_) return;
    const std::string_view before = text_.substr(0, std::min(at_, text_.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::string_view last_line = before.substr(before.rfind('\n') + 1);  // npos + 1 is 0
    const auto column = 1 + std::count_if(last_line.begin(), last_line.end(), [](char c) {
                          return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // counts characters, as toml++ does
                        });
    status_ = fail(ErrorCode::descriptor, "describe.syntax", message, file_, static_cast<int>(line),
                   static_cast<int>(column));
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int dots_ = 0, brackets_ = 0;
  Status status_;
};

}  // namespace

Status guard_toml(std::string_view text, const std::string& file) {
  return TomlGuard(text, file).run();
}

}  // namespace relievo
