/// SPIR-V → the text of one target, by SPIRV-Cross.
#pragma once

#include <string>

#include "compile/bindings.hpp"
#include "compile/interface.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// Emits one shader. Bindings come from the layout alone; nothing flips Y or changes the depth range.
/// Errors: "compile.emit" for whatever SPIRV-Cross throws, "compile.binding-collision".
Result<std::string> emit_target(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                                const StageNeighbours& neighbours, std::string_view permutation_key);

}  // namespace relievo
