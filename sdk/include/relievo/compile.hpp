/// Vulkan GLSL → SPIR-V → every target, in process.
/// Every function here is thread-safe: calls from several threads are independent, each with compilers of its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/compose.hpp"
#include "relievo/job.hpp"

namespace relievo {

enum class Language { spirv, glsl, essl, hlsl, msl };

/// A language and version: spirv-1.0, glsl-330, essl-300, hlsl-5.0 (shader model), msl-2.2.
struct Target {
  Language language = Language::spirv;
  int version = 0;  ///< 330, 300; 50 for HLSL 5.0; 22 for MSL 2.2; 10 for SPIR-V 1.0

  friend bool operator==(const Target&, const Target&) = default;
};

/// Every target: spirv-1.0, glsl-330, glsl-430, glsl-450, essl-300, essl-310, hlsl-5.0, hlsl-5.1, hlsl-6.0, msl-2.2.
std::span<const Target> all_targets();
std::string to_string(const Target& target);
/// Errors: "compile.unknown-target", naming the nearest.
Result<Target> parse_target(std::string_view name);
/// The usual file extension of one shader: ".spv", ".glsl", ".hlsl", ".metal".
std::string_view file_extension(const Target& target);

/// Whether the capability table (target × stage × feature) allows it, decided before compiling.
/// The error is ErrorCode::unsupported with an id such as "capability.geometry" and names the fallback.
Status check_capabilities(const Target& target, const ComposedProgram& program, std::string_view fallback_stage);

struct CompiledShader {
  ShaderStage stage = ShaderStage::compute;
  std::vector<std::uint32_t> spirv;
  std::map<std::string, std::string> text;  ///< target name → source
};

struct CompiledProgram {
  std::string key;
  std::vector<CompiledShader> shaders;
  std::vector<BindingSlot> bindings;  ///< union over the shaders
  std::string reflection;             ///< JSON, schema in docs/reflection.md
};

struct CompileOptions {
  bool optimize = true;
  bool validate = true;  ///< spirv-val on the result
  unsigned threads = 1;  ///< for the shaders and targets of one program; 0 = all. The outputs do not depend on it
};

/// Compiles a program for all `targets`; SPIR-V is always made. Errors: "compile.glsl" with the author's file and line,
/// "capability.*", "lint.*" and the other "compile.*" of docs/targets.md.
/// Thread-safe: calls from several threads are independent.
Result<CompiledProgram> compile(const ComposedProgram& program, std::span<const Target> targets,
                                const CompileOptions& options = {}, std::string_view fallback_stage = {});

/// The Job form: specialization values from the composed program's parameters.
ShaderProgram to_shader_program(const ComposedProgram& composed, const CompiledProgram& compiled);

}  // namespace relievo
