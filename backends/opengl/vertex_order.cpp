#include "vertex_order.hpp"

#include <algorithm>
#include <cctype>

namespace relievo::opengl {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The text's length up to the first place that is not white space.
std::size_t space_length(std::string_view text) {
  return std::min(text.find_first_not_of(" \t\r\n"), text.size());
}

std::size_t word_length(std::string_view text) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_word) - text.begin());
}

/// Takes `token` and the white space before it off the text.
bool take(std::string_view& text, std::string_view token) {
  const std::string_view rest = text.substr(space_length(text));
  if (!rest.starts_with(token)) return false;
  text = rest.substr(token.size());
  return true;
}

/// Given what follows the word `layout`: whether it qualifies the shader's input as a whole, `(…) in;`.
bool is_input_layout(std::string_view text) {
  if (!take(text, "(")) return false;
  const std::size_t close = text.find(')');
  if (close == std::string_view::npos) return false;
  text.remove_prefix(close + 1);
  return take(text, "in") && take(text, ";");
}

std::string_view exchanged(std::string_view word) {
  if (word == "cw") return "ccw";
  return word == "ccw" ? "cw" : word;
}

}  // namespace

std::string exchange_vertex_order(std::string_view source) {
  std::string result;
  bool in_layout = false;
  while (!source.empty()) {
    const std::size_t length = std::max<std::size_t>(1, word_length(source));
    const std::string_view word = source.substr(0, length);
    source.remove_prefix(length);
    if (word == "layout") in_layout = is_input_layout(source);
    if (word == ")") in_layout = false;
    result += in_layout ? exchanged(word) : word;
  }
  return result;
}

}  // namespace relievo::opengl
