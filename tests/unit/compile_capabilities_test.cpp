#include <gtest/gtest.h>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

using testing::compute_program;
using testing::fragment_program;
using testing::prism_sample;

Error refusal(const ComposedProgram& program, const char* target, std::string_view fallback = {}) {
  const Target targets[] = {*parse_target(target)};
  const auto compiled = compile(program, targets, {}, fallback);
  return compiled ? Error{} : compiled.error();
}

TEST(CompileCapabilities, GeometryIsRefusedOnHlslBeforeAnythingIsParsed) {
  ComposedProgram program = prism_sample();
  program.stage = "prism";
  for (ComposedShader& shader : program.shaders) shader.text = "this is not GLSL";
  const Error error = refusal(program, "hlsl-5.0", "prism_pulled");
  EXPECT_EQ(error.code, ErrorCode::unsupported);
  EXPECT_EQ(error.id, "capability.geometry");
  EXPECT_EQ(error.message,
            "target hlsl-5.0 has no geometry shaders for stage 'prism'; use stage 'prism_pulled' instead");
}

TEST(CompileCapabilities, GeometryIsRefusedOnMetalAndEssl300) {
  EXPECT_EQ(refusal(prism_sample(), "msl-2.2").id, "capability.geometry");
  EXPECT_EQ(refusal(prism_sample(), "hlsl-6.0").id, "capability.geometry");
  EXPECT_EQ(refusal(prism_sample(), "essl-300").id, "capability.geometry");
}

TEST(CompileCapabilities, WithoutAFallbackTheMessageSaysSo) {
  EXPECT_NE(refusal(prism_sample(), "msl-2.2").message.find("; there is no fallback"), std::string::npos);
}

TEST(CompileCapabilities, WithoutAFallbackStageALaterVersionIsNamed) {
  const Error error = refusal(testing::ray_sample(), "glsl-330");
  EXPECT_EQ(error.id, "capability.compute");
  EXPECT_NE(error.message.find("use target glsl-430 or higher"), std::string::npos) << error.message;
}

TEST(CompileCapabilities, GeometryIsAllowedWhereTheTableHasIt) {
  for (const char* target : {"spirv-1.0", "glsl-330", "glsl-430", "glsl-450", "essl-310"}) {
    EXPECT_EQ(refusal(prism_sample(), target).id, "") << target;
  }
}

TEST(CompileCapabilities, ComputeNeedsGlsl430AndEssl310) {
  const ComposedProgram program = compute_program("void main() {}");
  EXPECT_EQ(refusal(program, "glsl-330").id, "capability.compute");
  EXPECT_EQ(refusal(program, "essl-300").id, "capability.compute");
  for (const char* target : {"glsl-430", "essl-310", "hlsl-5.0", "msl-2.2"}) {
    EXPECT_EQ(refusal(program, target).id, "") << target;
  }
}

TEST(CompileCapabilities, ADeclaredFeatureIsCheckedBeforeCompiling) {
  ComposedProgram program = fragment_program("void main() {}");
  program.features = {"gather"};
  for (ComposedShader& shader : program.shaders) shader.text = "this is not GLSL";
  EXPECT_EQ(refusal(program, "essl-300").id, "capability.gather");
  EXPECT_EQ(refusal(program, "glsl-330").id, "capability.gather");
}

constexpr const char* kGather = R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
void main() { color = textureGather(map, uv); }
)";

TEST(CompileCapabilities, AnUndeclaredGatherIsFoundInTheSpirv) {
  const Error error = refusal(fragment_program(kGather), "essl-300");
  EXPECT_EQ(error.id, "capability.gather");
  EXPECT_NE(error.message.find("use target essl-310 or higher"), std::string::npos) << error.message;
  EXPECT_EQ(refusal(fragment_program(kGather), "essl-310").id, "");
}

TEST(CompileCapabilities, AnImageFormatThatEsslLacksIsFoundInTheSpirv) {
  const ComposedProgram program = fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0, rgba16) readonly uniform highp image2D map;
void main() { color = imageLoad(map, ivec2(0)); }
)");
  EXPECT_EQ(refusal(program, "essl-310").id, "capability.extended-images");
  EXPECT_EQ(refusal(program, "glsl-330").id, "capability.extended-images");
  for (const char* target : {"glsl-430", "hlsl-5.0", "msl-2.2"}) EXPECT_EQ(refusal(program, target).id, "") << target;
}

TEST(CompileCapabilities, AStorageBufferInAFragmentShaderIsFoundInTheSpirv) {
  const ComposedProgram program = fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 2, binding = 0, std430) readonly buffer Colors { vec4 data[]; } colors;
void main() { color = colors.data[int(gl_FragCoord.x)]; }
)");
  EXPECT_EQ(refusal(program, "glsl-330").id, "capability.storage-buffer");
  EXPECT_EQ(refusal(program, "essl-300").id, "capability.storage-buffer");
  EXPECT_EQ(refusal(program, "hlsl-5.0").id, "");
}

TEST(CompileCapabilities, TextureQueryLodIsRefusedOnEsslAndWorksOnMetal) {
  const ComposedProgram program = fragment_program(R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
void main() { color = vec4(textureQueryLod(map, uv), 0.0, 1.0); }
)");
  EXPECT_EQ(refusal(program, "essl-310").id, "capability.query-lod");
  EXPECT_EQ(refusal(program, "msl-2.2").id, "");
  EXPECT_EQ(refusal(program, "glsl-450").id, "");
}

TEST(CompileCapabilities, ATargetOutsideTheListIsRefused) {
  const Target targets[] = {{Language::hlsl, 30}};
  const auto compiled = compile(prism_sample(), targets);
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().id, "compile.unknown-target");
}

}  // namespace
}  // namespace relievo
