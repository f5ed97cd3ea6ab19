/// The second half of compiling: from SPIR-V that ships to every target.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "compile/spirv_words.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// Emits and reflects a program whose shaders have these words, in the order of `program.shaders`, of which only the
/// stages count. `front_end_words`, when given, explain words that are invalid. Errors: "capability.*",
/// "compile.interface", "compile.spirv-invalid", "compile.emit", "compile.binding-collision". May throw std::exception.
Result<CompiledProgram> emit_program(const ComposedProgram& program, std::vector<SpirvWords> words,
                                     std::span<const Target> targets, const CompileOptions& options,
                                     std::string_view fallback_stage, std::span<const SpirvWords> front_end_words = {});

}  // namespace relievo
