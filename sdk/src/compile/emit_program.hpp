/// The second half of compiling: from SPIR-V that ships to every target.
#pragma once

#include <span>
#include <string_view>

#include "compile/emit_memo.hpp"
#include "compile/parallel.hpp"
#include "compile/shader_module.hpp"
#include "relievo/compile.hpp"

namespace relievo {

struct EmitContext {
  std::span<const SpirvWords> front_end_words;  ///< one a module, for validation to explain; needed for that alone
  EmitMemo* memo = nullptr;                     ///< texts of modules that other programs have as well; may be null
};

/// Emits and reflects a program from its modules. Errors: "capability.*", "compile.interface",
/// "compile.spirv-invalid", "compile.emit", "compile.binding-collision". May throw std::exception.
Result<CompiledProgram> emit_program(const ComposedProgram& program, std::span<const ShaderModule> modules,
                                     std::span<const Target> targets, const CompileOptions& options,
                                     std::string_view fallback_stage, const EmitContext& context, Crew& crew);

}  // namespace relievo
