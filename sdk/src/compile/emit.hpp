/// SPIR-V → the texts of the targets, by SPIRV-Cross.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compile/bindings.hpp"
#include "compile/interface.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// Targets whose texts share work, in the order in which they are emitted.
using TargetFamily = std::vector<Target>;

/// Sorts targets into families: GLSL with ESSL, HLSL, MSL. Those without a text are left out.
std::vector<TargetFamily> group_targets(std::span<const Target> targets);

/// Emits one shader for every target of a family, in its order. Bindings come from the layout alone; nothing flips Y or
/// changes the depth range. A text does not depend on which other targets are in the family.
/// Errors: "compile.emit" for whatever SPIRV-Cross throws, "compile.binding-collision".
Result<std::vector<std::string>> emit_family(const TargetFamily& family, const ShaderModule& module,
                                             const BindingLayout& layout, const StageNeighbours& neighbours,
                                             std::string_view permutation_key);

}  // namespace relievo
