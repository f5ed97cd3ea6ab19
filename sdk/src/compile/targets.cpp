#include <fmt/format.h>

#include <array>
#include <string>

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
  const std::string_view name = language_name(target.language);
  if (!has_minor(target.language)) return fmt::format("{}-{}", name, target.version);
  return fmt::format("{}-{}.{}", name, target.version / 10, target.version % 10);
}

Result<Target> parse_target(std::string_view name) {
  std::vector<std::string> names;
  for (const Target& target : kTargets) {
    names.push_back(to_string(target));
    if (names.back() == name) return target;
  }
  const std::string nearest = nearest_name(name, names);
  const std::string advice = nearest.empty() ? fmt::format("expected one of {}", fmt::join(names, ", "))
                                             : fmt::format("did you mean '{}'?", nearest);
  return fail(ErrorCode::usage, "compile.unknown-target", fmt::format("'{}' is not a target; {}", name, advice));
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
