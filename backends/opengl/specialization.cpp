#include "specialization.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace relievo::opengl {
namespace {

enum class ConstantType { int32, uint32, float32, boolean };

bool is_word(char c) {
  return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

/// Takes the next line off `rest`, without its end.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const auto end = std::find_if_not(text.begin(), text.end(), is_word);
  const auto length = static_cast<std::size_t>(end - text.begin());
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

/// The type of `const float NAME = MACRO;`.
std::optional<ConstantType> declared_type(std::string_view line, std::string_view macro) {
  if (take_word(line) != "const") return std::nullopt;
  const std::string_view type = take_word(line);
  take_word(line);
  line = trimmed(line);
  if (line.empty() || line.front() != '=') return std::nullopt;
  line.remove_prefix(1);
  if (take_word(line) != macro) return std::nullopt;
  if (type == "float") return ConstantType::float32;
  if (type == "uint") return ConstantType::uint32;
  if (type == "bool") return ConstantType::boolean;
  return ConstantType::int32;
}

/// The type of the default in `#define MACRO 0.5`; a constant that only sizes a work group is declared nowhere else.
std::optional<ConstantType> default_type(std::string_view line, std::string_view macro) {
  line = trimmed(line);
  if (line.empty() || line.front() != '#') return std::nullopt;
  line.remove_prefix(1);
  if (take_word(line) != "define" || take_word(line) != macro) return std::nullopt;
  line = trimmed(line);
  if (line == "true" || line == "false") return ConstantType::boolean;
  if (line.ends_with('u') || line.ends_with('U')) return ConstantType::uint32;
  return line.find_first_of(".eE") != std::string_view::npos ? ConstantType::float32 : ConstantType::int32;
}

std::optional<ConstantType> find_type(std::string_view source, std::string_view macro) {
  std::optional<ConstantType> fallback;
  while (!source.empty()) {
    const std::string_view line = take_line(source);
    if (const auto type = declared_type(line, macro)) return type;
    if (!fallback) fallback = default_type(line, macro);
  }
  return fallback;
}

/// Nine significant digits give a float back exactly; what digits cannot say is built from its bits.
std::string float_literal(std::uint32_t bits) {
  const float value = std::bit_cast<float>(bits);
  if (!std::isfinite(value)) return fmt::format("uintBitsToFloat(0x{:08x}u)", bits);
  std::string digits = fmt::format("{:.9g}", value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return fmt::format("({})", digits);
}

std::string literal(ConstantType type, std::uint32_t bits) {
  switch (type) {
    case ConstantType::float32:
      return float_literal(bits);
    case ConstantType::uint32:
      return fmt::format("{}u", bits);
    case ConstantType::boolean:
      return bits != 0 ? "true" : "false";
    case ConstantType::int32:
      break;
  }
  const auto value = static_cast<std::int32_t>(bits);
  // The smallest int has no decimal literal.
  if (value == INT32_MIN) return "(-2147483647 - 1)";
  return value < 0 ? fmt::format("({})", value) : fmt::format("{}", value);
}

/// Where the leading block of #version, #extension and blank lines ends; `lines` counts them.
std::size_t end_of_preamble(std::string_view source, int& lines) {
  std::size_t end = 0;
  int line_number = 0;
  std::string_view rest = source;
  while (!rest.empty()) {
    std::string_view line = trimmed(take_line(rest));
    ++line_number;
    if (!line.starts_with("#version") && !line.starts_with("#extension")) {
      if (line.empty()) continue;
      break;
    }
    end = source.size() - rest.size();
    lines = line_number;
  }
  return end;
}

}  // namespace

std::string specialize(std::string_view source, const std::vector<SpecializationValue>& constants) {
  std::string defines;
  for (const SpecializationValue& constant : constants) {
    const std::string macro = fmt::format("SPIRV_CROSS_CONSTANT_ID_{}", constant.id);
    const auto type = find_type(source, macro);
    if (type) defines += fmt::format("#define {} {}\n", macro, literal(*type, constant.bits));
  }
  if (defines.empty()) return std::string(source);
  int lines = 0;
  const std::size_t place = end_of_preamble(source, lines);
  return fmt::format("{}{}{}#line {}\n{}", source.substr(0, place), place > 0 && source[place - 1] != '\n' ? "\n" : "",
                     defines, lines + 1, source.substr(place));
}

}  // namespace relievo::opengl
