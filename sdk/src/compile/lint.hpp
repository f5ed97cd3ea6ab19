/// Checks that no compiler of ours makes, on the SPIR-V before optimization.
#pragma once

#include <string_view>

#include "compile/spirv_words.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// Refuses what needs implicit derivatives (`texture`, `textureProj`, `textureQueryLod`, `dFdx`, `fwidth`, …) inside a
/// loop, or in a function that a loop calls: Microsoft's compiler unrolls such loops, and fails on ray marchers. Wants
/// structured control flow and line information. Error: "lint.implicit-lod-in-loop" with the author's file and line.
Status lint_implicit_lod_in_loop(const SpirvWords& words, std::string_view permutation_key);

}  // namespace relievo
