/// What each target can do, decided from one table before a target's emitter is called.
#pragma once

#include <string_view>

#include "compile/bindings.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// As `check_capabilities`, for what the SPIR-V itself uses, declared or not: texture gather, storage buffers, …
Status check_module_capabilities(const Target& target, const ShaderModule& module, const ComposedProgram& program,
                                 std::string_view fallback_stage);

}  // namespace relievo
