#include "compile/binding_collisions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace relievo {

namespace {

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// What follows `mark` up to `end`; empty when the line has no mark.
std::string_view between(std::string_view line, std::string_view mark, std::string_view end) {
  const std::size_t at = line.find(mark);
  if (at == std::string_view::npos) return {};
  line.remove_prefix(at + mark.size());
  return line.substr(0, line.find_first_of(end));
}

/// "texture unit 3" of a GLSL declaration with layout(binding = 3).
std::string glsl_slot(std::string_view line) {
  if (line.substr(0, 7) != "layout(") return {};
  const std::string_view number = between(line, "binding = ", ",)");
  if (number.empty()) return {};
  const std::string_view declaration = line.substr(line.find(')'));
  std::string_view space = "uniform block";
  if (contains(declaration, "buffer ")) {
    space = "storage block";
  } else if (contains(declaration, " sampler") || contains(declaration, " isampler") ||
             contains(declaration, " usampler")) {
    space = "texture unit";
  } else if (contains(declaration, "image")) {
    space = "image unit";
  }
  return fmt::format("{} {}", space, number);
}

/// "t0" or "t0, space1" of an HLSL declaration; the space is part of the identity.
std::string hlsl_slot(std::string_view line) {
  std::string_view slot = between(line, "register(", ")");
  constexpr std::string_view kDefaultSpace = ", space0";
  if (slot.ends_with(kDefaultSpace)) slot.remove_suffix(kDefaultSpace.size());
  return std::string(slot);
}

template <class AddSlot>
void for_each_line(std::string_view text, AddSlot&& add) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    add(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Metal declares all indices in the entry point's signature, as "[[buffer(0)]]"; the first repeated one.
std::string find_msl_collision(std::string_view text) {
  std::set<std::string_view> seen;
  for (std::size_t at = text.find("[["); at != std::string_view::npos; at = text.find("[[", at + 2)) {
    const std::string_view attribute = text.substr(at + 2, text.find("]]", at) - at - 2);
    const bool is_index = attribute.substr(0, 7) == "buffer(" || attribute.substr(0, 8) == "texture(" ||
                          attribute.substr(0, 8) == "sampler(";
    if (is_index && !seen.insert(attribute).second) return std::string(attribute);
  }
  return {};
}

}  // namespace

std::string find_binding_collision(Language language, std::string_view text) {
  if (language == Language::msl) return find_msl_collision(text);
  if (language == Language::spirv) return {};
  std::set<std::string> seen;
  std::string repeated;
  for_each_line(text, [&](std::string_view line) {
    std::string slot = language == Language::hlsl ? hlsl_slot(line) : glsl_slot(line);
    if (!slot.empty() && !seen.insert(slot).second && repeated.empty()) repeated = slot;
  });
  return repeated;
}

}  // namespace relievo
