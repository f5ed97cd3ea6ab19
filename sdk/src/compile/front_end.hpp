/// Vulkan GLSL → SPIR-V by glslang, in process.
#pragma once

#include <vector>

#include "compile/parallel.hpp"
#include "compile/spirv_words.hpp"
#include "relievo/compose.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// Parses every shader of the program with the semantics of Vulkan 1.0, links them, and returns SPIR-V 1.0, one module
/// a shader, in order. The modules carry line information, so that a check on them can name the author's file and line.
/// Errors: "compile.glsl".
Result<std::vector<SpirvWords>> run_front_end(const ComposedProgram& program, Crew& crew);

}  // namespace relievo
