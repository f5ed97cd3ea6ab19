/// The emitters, one a language. They throw what SPIRV-Cross throws; `emit_target` catches.
#pragma once

#include <string>

#include "compile/bindings.hpp"
#include "compile/interface.hpp"
#include "relievo/compile.hpp"

namespace relievo {

std::string emit_glsl(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours);
std::string emit_hlsl(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours);
std::string emit_msl(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                     const StageNeighbours& neighbours);

}  // namespace relievo
