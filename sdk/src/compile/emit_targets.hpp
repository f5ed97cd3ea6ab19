/// The emitters, one a family of languages. They throw what SPIRV-Cross throws; `emit_family` catches.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "compile/bindings.hpp"
#include "compile/interface.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// Takes the texts in the order of the targets, each before the next is begun.
using TextSink = std::function<void(std::string text)>;

/// GLSL and ESSL.
void emit_glsl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
               const StageNeighbours& neighbours, const TextSink& sink);
void emit_hlsl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
               const StageNeighbours& neighbours, const TextSink& sink);
void emit_msl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
              const StageNeighbours& neighbours, const TextSink& sink);

}  // namespace relievo
