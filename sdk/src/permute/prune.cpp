#include "permute/prune.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "describe/source_path.hpp"

namespace relievo {

namespace {

/// The manifest without its folders; a descriptor's file is a path of the source tree. Archives hold the reasons, and
/// are the same wherever the project lies.
std::string with_place(const Rule& rule, const Manifest& manifest) {
  const std::string file = rule.file == manifest.file ? file_name_of(rule.file) : rule.file;
  return fmt::format("{} ({}:{})", to_string(rule), file, rule.line);
}

/// What the capability table asks about a program: its shaders' stages and its features.
ComposedProgram outline(const Parts& parts) {
  ComposedProgram program;
  program.stage = parts.stage->name;
  program.features = features_of(parts);
  for (const StageShader& shader : parts.stage->shaders) program.shaders.push_back({shader.stage, {}, {}});
  return program;
}

}  // namespace

std::string Pruner::scene_reason(const Parts& parts) const {
  const SceneNeeds& scene = manifest_.scene;
  for (const TechniqueDescriptor* technique : parts.techniques) {
    if (technique->first_hit >= scene.first_hit) continue;
    return fmt::format("the scene wants the first hit {}; {} finds it {}", to_string(scene.first_hit), technique->name,
                       to_string(technique->first_hit));
  }
  for (const MapDescriptor* map : parts.maps) {
    if (!scene.maps || std::find(scene.maps->begin(), scene.maps->end(), map->name) != scene.maps->end()) continue;
    return fmt::format("the scene has no map {}", map->name);
  }
  const FeatureSet features = features_of(parts);
  for (const std::string& feature : scene.without_features) {
    if (features.contains(feature)) return fmt::format("the scene does without the feature {}", feature);
  }
  return {};
}

std::string Pruner::rule_reason(const Parts& parts, const Facts& facts) const {
  if (const Rule* broken = broken_rule(parts, facts)) return with_place(*broken, manifest_);
  for (const Rule& rule : manifest_.rules) {
    if (is_broken(rule, facts)) return with_place(rule, manifest_);
  }
  return {};
}

const std::string& Pruner::capability_reason(const Parts& parts, const Target& target) {
  const ComposedProgram program = outline(parts);
  const std::string key = fmt::format("{} {} {}", program.stage, fmt::join(program.features, ","), to_string(target));
  const auto known = capabilities_.find(key);
  if (known != capabilities_.end()) return known->second;
  const Status status = check_capabilities(target, program, parts.stage->fallback);
  return capabilities_[key] = status ? "" : fmt::format("{} [{}]", status.error().message, status.error().id);
}

std::vector<std::string> Pruner::reasons(const Parts& parts, const Permutation& permutation) {
  std::vector<std::string> reasons(manifest_.targets.size());
  Facts facts = facts_of(parts, permutation);
  std::string for_all = scene_reason(parts);
  if (for_all.empty()) for_all = rule_reason(parts, facts);
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    reasons[i] = for_all;
    if (!for_all.empty()) continue;
    facts["target"] = {to_string(manifest_.targets[i])};
    reasons[i] = rule_reason(parts, facts);
    if (reasons[i].empty()) reasons[i] = capability_reason(parts, manifest_.targets[i]);
  }
  return reasons;
}

}  // namespace relievo
