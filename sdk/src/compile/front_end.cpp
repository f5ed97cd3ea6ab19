#include "compile/front_end.hpp"

#include <fmt/format.h>
#include <glslang/Include/PoolAlloc.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <memory>
#include <span>
#include <string>

#include "compile/complexity.hpp"
#include "compile/constant_parameters.hpp"
#include "compile/diagnostics.hpp"

namespace relievo {

namespace {

// Cascading: several errors of one shader are reported together.
constexpr auto kMessages =
    static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgCascadingErrors | EShMsgSuppressWarnings);

/// glslang's process-wide tables are made once, and live until the process ends.
void initialize_once() {
  static const bool initialized = glslang::InitializeProcess();
  static_cast<void>(initialized);
}

EShLanguage glslang_stage(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::vertex:
      return EShLangVertex;
    case ShaderStage::tessellation_control:
      return EShLangTessControl;
    case ShaderStage::tessellation_evaluation:
      return EShLangTessEvaluation;
    case ShaderStage::geometry:
      return EShLangGeometry;
    case ShaderStage::fragment:
      return EShLangFragment;
    case ShaderStage::compute:
      return EShLangCompute;
  }
  return EShLangCompute;
}

/// A parsed shader with the strings that glslang keeps pointers to.
class ParsedShader {
 public:
  explicit ParsedShader(const ComposedShader& source)
      : shader_(glslang_stage(source.stage)),
        text_(source.text.c_str()),
        length_(static_cast<int>(source.text.size())),
        name_(fmt::format("composed.{}.glsl", to_string(source.stage))),
        name_pointer_(name_.c_str()) {
    shader_.setStringsWithLengthsAndNames(&text_, &length_, &name_pointer_, 1);
    shader_.setEnvInput(glslang::EShSourceGlsl, shader_.getStage(), glslang::EShClientVulkan, 100);
    shader_.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_0);
    shader_.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
  }

  bool parse() {
    if (!shader_.parse(GetDefaultResources(), 450, false, kMessages)) return false;
    make_read_parameters_constant(*shader_.getIntermediate());
    return true;
  }
  glslang::TShader& shader() { return shader_; }

 private:
  glslang::TShader shader_;
  const char* text_;
  int length_;
  std::string name_;
  const char* name_pointer_;
};

SpirvWords generate_spirv(const glslang::TIntermediate& intermediate, glslang::TPoolAllocator& pool) {
  glslang::SetThreadPoolAllocator(&pool);  // a thread that has parsed nothing has none
  glslang::SpvOptions options;
  options.generateDebugInfo = true;
  options.disableOptimizer = true;
  options.validate = false;
  SpirvWords words;
  spv::SpvBuildLogger logger;
  glslang::GlslangToSpv(intermediate, words, &logger, &options);
  return words;
}

tl::unexpected<Error> too_complex(const ComposedShader& source, std::string_view key) {
  return fail(ErrorCode::compile, "compile.glsl",
              fmt::format("the {} shader chains more than {} operators in one expression (permutation '{}')",
                          to_string(source.stage), kMaxChainedOperators, key));
}

/// Parses every shader; the first error in their order is the one reported.
Status parse_all(std::span<const std::unique_ptr<ParsedShader>> shaders, std::span<const std::size_t> order, Crew& crew,
                 const ComposedProgram& program) {
  enum class Outcome : char { parsed, too_complex, wrong };
  std::vector<Outcome> outcomes(shaders.size(), Outcome::too_complex);
  crew.run(order, [&](std::size_t i) {
    if (has_runaway_expression(program.shaders[i].text)) return;
    outcomes[i] = shaders[i]->parse() ? Outcome::parsed : Outcome::wrong;
  });
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    if (outcomes[i] == Outcome::parsed) continue;
    if (outcomes[i] == Outcome::too_complex) return too_complex(program.shaders[i], program.key);
    Error error = glsl_error(shaders[i]->shader().getInfoLog(), program.key);
    error.column = find_column(program.shaders[i].text, error);
    return tl::unexpected(std::move(error));
  }
  return {};
}

}  // namespace

Result<std::vector<SpirvWords>> run_front_end(const ComposedProgram& program, Crew& crew) {
  initialize_once();
  // Destroyed last: glslang keeps pointing at the thread's pool.
  std::vector<glslang::TPoolAllocator> pools(program.shaders.size());
  glslang::SetThreadPoolAllocator(&pools.front());
  std::vector<std::unique_ptr<ParsedShader>> shaders;
  glslang::TProgram linked;  // destroyed before the shaders it refers to
  for (const ComposedShader& source : program.shaders) {
    shaders.push_back(std::make_unique<ParsedShader>(source));
    linked.addShader(&shaders.back()->shader());
  }
  const std::vector<std::size_t> order =
      largest_first(shaders.size(), [&](std::size_t i) { return program.shaders[i].text.size(); });
  if (auto ok = parse_all(shaders, order, crew, program); !ok) return tl::unexpected(ok.error());
  if (!linked.link(kMessages)) return tl::unexpected(glsl_error(linked.getInfoLog(), program.key));

  std::vector<SpirvWords> modules(shaders.size());
  crew.run(order, [&](std::size_t i) {
    modules[i] = generate_spirv(*linked.getIntermediate(shaders[i]->shader().getStage()), pools[i]);
  });
  return modules;
}

}  // namespace relievo
