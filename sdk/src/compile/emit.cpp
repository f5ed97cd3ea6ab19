#include "compile/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "compile/binding_collisions.hpp"
#include "compile/emit_targets.hpp"

namespace relievo {

namespace {

/// The language that stands for a family.
Language family_of(const Target& target) {
  return target.language == Language::essl ? Language::glsl : target.language;
}

/// Old before new, so that what an old version refuses is refused first; GLSL's `precise` parts it, see emit_glsl.cpp.
bool is_emitted_before(const Target& a, const Target& b) {
  const auto order = [](const Target& target) {
    const bool has_precise = target.version >= (target.language == Language::essl ? 310 : 400);
    return std::tuple(has_precise, target.language, target.version);
  };
  return order(a) < order(b);
}

void emit_texts(const TargetFamily& family, const ShaderModule& module, const BindingLayout& layout,
                const StageNeighbours& neighbours, const TextSink& sink) {
  switch (family_of(family.front())) {
    case Language::glsl:
    case Language::essl:
      return emit_glsl(family, module, layout, neighbours, sink);
    case Language::hlsl:
      return emit_hlsl(family, module, layout, neighbours, sink);
    case Language::msl:
      return emit_msl(family, module, layout, neighbours, sink);
    case Language::spirv:
      return;
  }
}

std::string doing(const Target& target, const ShaderModule& module) {
  return fmt::format("emitting {} of the {} shader of", to_string(target), to_string(module.stage));
}

}  // namespace

std::vector<TargetFamily> group_targets(std::span<const Target> targets) {
  std::vector<TargetFamily> families;
  for (const Target& target : targets) {
    if (target.language == Language::spirv) continue;
    const auto known = std::find_if(families.begin(), families.end(), [&](const TargetFamily& family) {
      return family_of(family.front()) == family_of(target);
    });
    if (known == families.end()) {
      families.push_back({target});
    } else {
      known->push_back(target);
    }
  }
  for (TargetFamily& family : families) std::stable_sort(family.begin(), family.end(), is_emitted_before);
  return families;
}

Result<std::vector<std::string>> emit_family(const TargetFamily& family, const ShaderModule& module,
                                             const BindingLayout& layout, const StageNeighbours& neighbours,
                                             std::string_view permutation_key) {
  std::vector<std::string> texts;
  try {
    emit_texts(family, module, layout, neighbours, [&](std::string text) { texts.push_back(std::move(text)); });
  } catch (const std::exception& error) {
    return emit_error(doing(family[texts.size()], module), permutation_key, error.what());
  }
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string repeated = find_binding_collision(family[i].language, texts[i]);
    if (repeated.empty()) continue;
    return fail(ErrorCode::compile, "compile.binding-collision",
                fmt::format("While {} permutation '{}': two resources share {}", doing(family[i], module),
                            permutation_key, repeated));
  }
  return texts;
}

}  // namespace relievo
