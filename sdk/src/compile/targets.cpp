#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "relievo/compile.hpp"

namespace relievo {

namespace {

constexpr std::array<Target, 10> kTargets = {{
    {Language::spirv, 10},
    {Language::glsl, 330},
    {Language::glsl, 430},
    {Language::glsl, 450},
    {Language::essl, 300},
    {Language::essl, 310},
    {Language::hlsl, 50},
    {Language::hlsl, 51},
    {Language::hlsl, 60},
    {Language::msl, 22},
}};

std::string_view language_name(Language language) {
  switch (language) {
    case Language::spirv:
      return "spirv";
    case Language::glsl:
      return "glsl";
    case Language::essl:
      return "essl";
    case Language::hlsl:
      return "hlsl";
    case Language::msl:
      return "msl";
  }
  return "unknown";
}

/// GLSL and ESSL write their version as one number, the others as major.minor.
bool has_minor(Language language) {
  return language != Language::glsl && language != Language::essl;
}

}  // namespace

std::span<const Target> all_targets() {
  return kTargets;
}

std::string to_string(const Target& target) {
  std::string name(language_name(target.language));
  if (!has_minor(target.language)) return name + "-" + std::to_string(target.version);
  return name + "-" + std::to_string(target.version / 10) + "." + std::to_string(target.version % 10);
}

Result<Target> parse_target(std::string_view name) {
  std::vector<std::string> names;
  for (const Target& target : kTargets) {
    names.push_back(to_string(target));
    if (names.back() == name) return target;
  }
  const std::string nearest = nearest_name(name, names);
  std::string message = "'" + std::string(name) + "' is not a target; ";
  if (!nearest.empty()) {
    message += "did you mean '" + nearest + "'?";
  } else {
    message += "expected one of";
    for (const std::string& known : names) message += " " + known;
  }
  return fail(ErrorCode::usage, "compile.unknown-target", std::move(message));
}

std::string_view file_extension(const Target& target) {
  switch (target.language) {
    case Language::spirv:
      return ".spv";
    case Language::glsl:
    case Language::essl:
      return ".glsl";
    case Language::hlsl:
      return ".hlsl";
    case Language::msl:
      return ".metal";
  }
  return "";
}

}  // namespace relievo
