/// Second opinions on emitted texts: each is read again by a front end of its own language. Every check returns an
/// empty string when all is well, and the reason otherwise.
#pragma once

#include <string>
#include <vector>

#include "relievo/compile.hpp"

namespace relievo::testing {

/// Parses GLSL or ESSL with glslang as plain OpenGL text of its own version, and links the shaders with each other, so
/// that names of varyings and blocks are compared across stages.
std::string check_glsl_program(const Target& target, const std::vector<CompiledShader>& shaders);

/// Parses HLSL with glslang's front end, generates SPIR-V, and validates it. An execution oracle more than a validator:
/// Microsoft's compiler is stricter.
std::string check_hlsl(ShaderStage stage, const std::string& text);

/// spirv-val for Vulkan 1.0, and version 1.0 in the header.
std::string check_spirv(const std::vector<std::uint32_t>& words);

/// Every text of every shader by the check of its language; Metal's, which has none here, for what can be seen in it.
std::string check_program(const CompiledProgram& program);

}  // namespace relievo::testing
