/// Vulkan GLSL to SPIR-V for tests of the backends, apart from the SDK's own compile stage.
#pragma once

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "relievo/job.hpp"

namespace relievo::test {

inline EShLanguage glslang_stage(ShaderStage stage) {
  constexpr EShLanguage stages[] = {EShLangVertex,   EShLangTessControl, EShLangTessEvaluation,
                                    EShLangGeometry, EShLangFragment,    EShLangCompute};
  return stages[static_cast<std::size_t>(stage)];
}

/// Compiles `body` after a "#version 450" line. A compile error fails the test and yields no code.
inline ShaderCode compile_glsl(ShaderStage stage, const std::string& body) {
  static const bool initialised = glslang::InitializeProcess();
  EXPECT_TRUE(initialised);
  const std::string source = "#version 450\n" + body;
  const char* const text = source.c_str();
  glslang::TShader shader(glslang_stage(stage));
  shader.setStrings(&text, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, glslang_stage(stage), glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  constexpr auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  ShaderCode code;
  code.stage = stage;
  if (!shader.parse(GetDefaultResources(), 450, false, messages)) {
    ADD_FAILURE() << shader.getInfoLog() << source;
    return code;
  }
  glslang::TProgram program;
  program.addShader(&shader);
  EXPECT_TRUE(program.link(messages)) << program.getInfoLog();
  glslang::GlslangToSpv(*program.getIntermediate(glslang_stage(stage)), code.spirv);
  return code;
}

}  // namespace relievo::test
