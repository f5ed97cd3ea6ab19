#include "permute/hot_reload/reach.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "permute/closure.hpp"

namespace relievo {

SourceChanges changes_between(const SourceTree& before, const SourceTree& after) {
  SourceChanges changes;
  const auto add = [&](const std::string& path, bool came_or_went) {
    changes.files.insert(path);
    changes.may_reach_all = changes.may_reach_all || came_or_went || path.ends_with(".toml");
  };
  for (const auto& [path, text] : before) {
    const auto other = after.find(path);
    if (other == after.end() || other->second != text) add(path, other == after.end());
  }
  for (const auto& [path, text] : after) {
    if (!before.contains(path)) add(path, true);
  }
  return changes;
}

bool reaches(const SourceChanges& changes, const ComposedProgram& program) {
  if (changes.may_reach_all) return true;
  return std::any_of(program.shaders.begin(), program.shaders.end(), [&](const ComposedShader& shader) {
    return std::any_of(shader.files.begin(), shader.files.end(),
                       [&](const std::string& file) { return changes.files.contains(file); });
  });
}

CacheKey fingerprint(const ComposedProgram& program) {
  std::string contract = describe_contract(program);
  for (const ParameterSlot& slot : program.parameters) contract += fmt::format("{} ", slot.default_value);
  std::vector<std::string_view> parts = {contract};
  for (const ComposedShader& shader : program.shaders) {
    parts.push_back(to_string(shader.stage));
    parts.push_back(shader.text);
  }
  return cache_key(parts);
}

}  // namespace relievo
