/// What a program may cost, from its SPIR-V.
#pragma once

#include <span>
#include <string>

#include "compile/spirv_words.hpp"
#include "relievo/compose.hpp"

namespace relievo {

/// JSON (docs/permutations.md): instructions, texture fetches in the text, loops with their bounds, and the bound on
/// fetches at run time, a shader. Bounds of loops that count to a uniform or an open specialization constant are those
/// of its default; a loop whose bound is not read off the text has none, and then neither have the fetches.
std::string describe_cost(const ComposedProgram& program, std::span<const SpirvWords> modules);

}  // namespace relievo
