#include "compile/emit.hpp"

#include <fmt/format.h>

#include "compile/binding_collisions.hpp"
#include "compile/emit_targets.hpp"

namespace relievo {

namespace {

std::string emit_text(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours) {
  switch (target.language) {
    case Language::glsl:
    case Language::essl:
      return emit_glsl(target, module, layout, neighbours);
    case Language::hlsl:
      return emit_hlsl(target, module, layout, neighbours);
    case Language::msl:
      return emit_msl(target, module, layout, neighbours);
    case Language::spirv:
      break;
  }
  return {};
}

}  // namespace

Result<std::string> emit_target(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                                const StageNeighbours& neighbours, std::string_view permutation_key) {
  const std::string doing = fmt::format("emitting {} of the {} shader of", to_string(target), to_string(module.stage));
  return catch_emit_errors(doing, permutation_key, [&]() -> Result<std::string> {
    std::string text = emit_text(target, module, layout, neighbours);
    if (const std::string repeated = find_binding_collision(target.language, text); !repeated.empty()) {
      return fail(ErrorCode::compile, "compile.binding-collision",
                  fmt::format("While {} permutation '{}': two resources share {}", doing, permutation_key, repeated));
    }
    return text;
  });
}

}  // namespace relievo
