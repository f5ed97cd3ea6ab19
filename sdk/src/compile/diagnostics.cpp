#include "compile/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

namespace relievo {

namespace {

constexpr std::size_t kMaxListed = 10;
constexpr std::string_view kError = "ERROR: ";

std::string_view trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

/// Splits "path:12: message"; the path may itself hold colons and spaces, so the first ":<digits>: " decides.
std::optional<Diagnostic> split_place(std::string_view text) {
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':', colon + 1)) {
    int line = 0;
    const char* first = text.data() + colon + 1;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, line);
    if (error != std::errc() || last - end < 2 || end[0] != ':' || end[1] != ' ') continue;
    const std::string_view message(end + 1, static_cast<std::size_t>(last - end - 1));
    return Diagnostic{std::string(text.substr(0, colon)), line, std::string(trim(message))};
  }
  return std::nullopt;
}

/// "2 compilation errors.  No code generated." and "'' : compilation terminated" say nothing of their own.
bool is_summary(std::string_view message) {
  return message.find("compilation errors.") != std::string_view::npos ||
         message.find("compilation terminated") != std::string_view::npos;
}

/// glslang writes "'token' : what"; without a token it leaves "'' : ", which reads as noise.
std::string_view without_empty_token(std::string_view message) {
  constexpr std::string_view kEmpty = "'' :";
  if (message.substr(0, kEmpty.size()) == kEmpty) message.remove_prefix(kEmpty.size());
  return trim(message);
}

std::string place_of(const Diagnostic& diagnostic) {
  return diagnostic.file.empty() ? std::string() : fmt::format("{}:{}: ", diagnostic.file, diagnostic.line);
}

}  // namespace

std::vector<Diagnostic> parse_glslang_log(std::string_view log) {
  std::vector<Diagnostic> diagnostics;
  bool continues = false;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    std::string_view text = trim(log.substr(0, end));
    log.remove_prefix(std::min(end + 1, log.size()));
    if (text.substr(0, kError.size()) != kError) {
      if (text.empty() || text.substr(0, 9) == "WARNING: ") continues = false;
      if (continues) diagnostics.back().message += fmt::format(" {}", text);
      continue;
    }
    text.remove_prefix(kError.size());
    continues = !is_summary(text);
    if (!continues) continue;
    Diagnostic diagnostic = split_place(text).value_or(Diagnostic{{}, 0, std::string(text)});
    diagnostic.message = without_empty_token(diagnostic.message);
    diagnostics.push_back(std::move(diagnostic));
  }
  return diagnostics;
}

Error glsl_error(std::string_view log, std::string_view permutation_key) {
  const std::vector<Diagnostic> diagnostics = parse_glslang_log(log);
  Error error{ErrorCode::compile, "compile.glsl", {}, {}, 0, 0};
  const auto placed =
      std::find_if(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) { return !d.file.empty(); });
  if (placed != diagnostics.end()) {
    error.file = placed->file;
    error.line = placed->line;
  }
  if (diagnostics.empty()) {
    error.message = fmt::format("permutation '{}' does not compile; the compiler gives no reason", permutation_key);
  } else if (diagnostics.size() == 1) {
    error.message = fmt::format("{} (permutation '{}')", diagnostics.front().message, permutation_key);
  } else {
    error.message = fmt::format("{} errors (permutation '{}')", diagnostics.size(), permutation_key);
    for (std::size_t i = 0; i < std::min(diagnostics.size(), kMaxListed); ++i) {
      error.message += fmt::format("\n  {}{}", place_of(diagnostics[i]), diagnostics[i].message);
    }
  }
  return error;
}

namespace {

/// The file and line that `#line 12 "file"` gives to the text after it.
struct LineMark {
  std::string_view file;
  int line = 0;
};

std::optional<LineMark> line_mark(std::string_view text) {
  constexpr std::string_view kLine = "#line ";
  if (text.substr(0, kLine.size()) != kLine) return std::nullopt;
  text.remove_prefix(kLine.size());
  LineMark mark;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), mark.line);
  const std::size_t open = text.find('"'), close = text.rfind('"');
  if (fault != std::errc() || open == close) return std::nullopt;
  mark.file = text.substr(open + 1, close - open - 1);
  return mark;
}

bool is_identifier_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// 1-based; 0: not there as a word of its own.
int column_of(std::string_view line, std::string_view token) {
  for (std::size_t at = line.find(token); at != line.npos; at = line.find(token, at + 1)) {
    const std::size_t end = at + token.size();
    const bool glued_before = at > 0 && is_identifier_part(line[at - 1]) && is_identifier_part(token.front());
    const bool glued_after = end < line.size() && is_identifier_part(line[end]) && is_identifier_part(token.back());
    if (!glued_before && !glued_after) return static_cast<int>(at) + 1;
  }
  return 0;
}

/// The token that glslang quotes: "'token' : what is wrong".
std::string_view quoted_token(std::string_view message) {
  const std::size_t open = message.find('\'');
  const std::size_t close = open == message.npos ? open : message.find('\'', open + 1);
  return close == message.npos ? std::string_view() : message.substr(open + 1, close - open - 1);
}

/// The token of "syntax error, unexpected RETURN", as it is written.
std::string unexpected_token(std::string_view message) {
  constexpr std::string_view words = "unexpected ";
  constexpr std::pair<std::string_view, std::string_view> marks[] = {
      {"left_brace", "{"}, {"right_brace", "}"}, {"left_paren", "("}, {"right_paren", ")"},
      {"semicolon", ";"},  {"comma", ","},       {"equal", "="},      {"colon", ":"}};
  const std::size_t at = message.find(words);
  if (at == message.npos) return {};
  message.remove_prefix(at + words.size());
  std::string token(message.substr(0, message.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789")));
  std::transform(token.begin(), token.end(), token.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [name, mark] : marks) {
    if (token == name) return std::string(mark);
  }
  return token;
}

/// Where the token is, or else where the line's text begins.
int best_column(std::string_view line, std::string_view token) {
  const int column = token.empty() ? 0 : column_of(line, token);
  return column > 0 ? column : static_cast<int>(std::min(line.find_first_not_of(" \t"), line.size())) + 1;
}

}  // namespace

int find_column(std::string_view text, const Error& error) {
  std::string token(quoted_token(error.message));
  if (token.empty()) token = unexpected_token(error.message);
  if (error.line == 0) return 0;
  LineMark place;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (const std::optional<LineMark> mark = line_mark(line)) {
      place = *mark;
      continue;
    }
    if (place.line == error.line && place.file == error.file) return best_column(line, token);
    ++place.line;
  }
  return 0;
}

}  // namespace relievo
