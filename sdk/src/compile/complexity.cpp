#include "compile/complexity.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace relievo {

namespace {

/// One level of parentheses: how many operators it chains, and whether its commas separate arguments.
struct Level {
  int operators = 0;
  bool is_call = false;
};

/// What a scan must look at: everything else is letters, digits and space, which are most of a text.
constexpr std::array<bool, 256> kMarks = [] {
  std::array<bool, 256> marks{};
  for (const char c : std::string_view("(){}[];#+-*/%&|^<>=?:,.")) marks[static_cast<unsigned char>(c)] = true;
  return marks;
}();

bool is_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The length of the comment or preprocessor line at the start of `text`; 0 when there is none.
std::size_t skipped_length(std::string_view text) {
  const bool block = text.substr(0, 2) == "/*";
  if (!block && text.substr(0, 2) != "//" && text[0] != '#') return 0;
  const std::size_t end = block ? text.find("*/", 2) : text.find('\n');
  return std::min(end, text.size() - 1) + 1;
}

class Scanner {
 public:
  /// Returns whether the limit is passed.
  bool take(char c, char next) {
    if (c == ';' || c == '{' || c == '}') {
      levels_ = {Level{}};
    } else if (c == '(') {
      levels_.push_back({0, is_name(previous_) || previous_ == ']'});
    } else if (c == ')') {
      if (levels_.size() > 1) levels_.pop_back();
    } else if (c == ',' && levels_.back().is_call) {
      levels_.back().operators = 0;
    } else if (is_operator(c, next)) {
      ++levels_.back().operators;
    }
    previous_ = c;
    return levels_.back().operators > kMaxChainedOperators;
  }
  /// For what is not a mark.
  void pass(char c) {
    if (static_cast<unsigned char>(c) > ' ') previous_ = c;
  }

 private:
  static bool is_operator(char c, char next) {
    if (c == '.') return std::isalpha(static_cast<unsigned char>(next)) != 0;
    return std::string_view("+-*/%&|^<>=?:[,").find(c) != std::string_view::npos;
  }

  std::vector<Level> levels_ = {Level{}};
  char previous_ = ' ';
};

}  // namespace

bool has_runaway_expression(std::string_view source) {
  Scanner scanner;
  for (std::size_t at = 0; at < source.size();) {
    if (!kMarks[static_cast<unsigned char>(source[at])]) {
      scanner.pass(source[at++]);
      continue;
    }
    if (const std::size_t skipped = skipped_length(source.substr(at)); skipped != 0) {
      at += skipped;
      continue;
    }
    if (scanner.take(source[at], at + 1 < source.size() ? source[at + 1] : ' ')) return true;
    ++at;
  }
  return false;
}

}  // namespace relievo
