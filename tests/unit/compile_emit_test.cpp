#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"
#include "support/target_checks.hpp"

namespace relievo {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Result<CompiledProgram> compile_for(const ComposedProgram& program, std::initializer_list<const char*> names,
                                    const CompileOptions& options = {}) {
  std::vector<Target> targets;
  for (const char* name : names) targets.push_back(*parse_target(name));
  return compile(program, targets, options);
}

void expect_accepted(const ComposedProgram& program, std::initializer_list<const char*> names) {
  for (const bool optimize : {true, false}) {
    const auto compiled = compile_for(program, names, {optimize, true});
    ASSERT_TRUE(compiled) << compiled.error().message;
    EXPECT_EQ(testing::check_program(*compiled), "") << (optimize ? "optimized" : "unoptimized");
  }
}

constexpr std::initializer_list<const char*> kWithCompute = {"glsl-430", "glsl-450", "essl-310", "hlsl-5.0",
                                                             "hlsl-5.1", "hlsl-6.0", "msl-2.2"};

TEST(CompileEmit, ComputeIsAcceptedByTheFrontEndOfEveryTarget) {
  expect_accepted(testing::ray_sample(), kWithCompute);
  expect_accepted(testing::bake_sample(), kWithCompute);
}

TEST(CompileEmit, SurfaceIsAcceptedByTheFrontEndOfEveryTarget) {
  expect_accepted(testing::surface_sample(), {"glsl-330", "glsl-430", "glsl-450", "essl-300", "essl-310", "hlsl-5.0",
                                              "hlsl-5.1", "hlsl-6.0", "msl-2.2"});
}

TEST(CompileEmit, GeometryAndTessellationAreAcceptedWhereTheTableHasThem) {
  expect_accepted(testing::prism_sample(), {"glsl-330", "glsl-430", "glsl-450", "essl-310"});
  expect_accepted(testing::tessellation_sample(), {"glsl-430", "glsl-450", "essl-310"});
}

TEST(CompileEmit, ShaderModelIsNotTheDefaultOfDirect3D9) {
  const auto compiled = compile_for(testing::surface_sample(), {"hlsl-5.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[1].text.at("hlsl-5.0"), HasSubstr("relievo_height_map.SampleGrad("));
  EXPECT_THAT(compiled->shaders[1].text.at("hlsl-5.0"), Not(HasSubstr("tex2D")));
}

TEST(CompileEmit, SpecializationConstantsAreMacrosOrFunctionConstants) {
  const auto compiled = compile_for(testing::ray_sample(), kWithCompute);
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto& text = compiled->shaders[0].text;
  for (const char* target : {"glsl-430", "glsl-450", "essl-310", "hlsl-5.0", "hlsl-5.1", "hlsl-6.0"}) {
    EXPECT_THAT(text.at(target), HasSubstr("#define SPIRV_CROSS_CONSTANT_ID_0 16")) << target;
    EXPECT_THAT(text.at(target), HasSubstr("#define SPIRV_CROSS_CONSTANT_ID_1 0.25")) << target;
  }
  EXPECT_THAT(text.at("msl-2.2"), HasSubstr("[[function_constant(0)]]"));
  EXPECT_THAT(text.at("msl-2.2"), HasSubstr("[[function_constant(1)]]"));
}

TEST(CompileEmit, NothingInEsslIsBelowHighp) {
  for (const bool optimize : {true, false}) {
    const auto compiled = compile_for(testing::surface_sample(), {"essl-300", "essl-310"}, {optimize, true});
    ASSERT_TRUE(compiled) << compiled.error().message;
    for (const CompiledShader& shader : compiled->shaders) {
      for (const auto& [name, text] : shader.text) {
        EXPECT_THAT(text, Not(HasSubstr("mediump"))) << name;
        EXPECT_THAT(text, Not(HasSubstr("lowp"))) << name;
        EXPECT_EQ(text.find("uniform sampler"), std::string::npos) << name << ": a sampler without highp is lowp";
      }
    }
    EXPECT_THAT(compiled->shaders[1].text.at("essl-300"), HasSubstr("precision highp float;\nprecision highp int;"));
  }
}

/// What else would sums that hold what rounding loses be good for?
TEST(CompileEmit, WhatIsPreciseIsSoWhereverTheLanguageHasTheWord) {
  const char* const text = R"(
layout(std430, set = 0, binding = 0) buffer Result { vec4 result[]; };
void main() {
  vec4 a = result[0], b = result[1];
  PRECISE vec4 sum = a + b;
  PRECISE vec4 lost = b - (sum - a);
  result[gl_GlobalInvocationID.x] = lost;
})";
  for (const bool is_precise : {true, false}) {
    std::string source = std::string("#define PRECISE ") + (is_precise ? "precise" : "") + text;
    const auto compiled = compile_for(testing::compute_program(source), kWithCompute);
    ASSERT_TRUE(compiled) << compiled.error().message;
    EXPECT_EQ(testing::check_program(*compiled), "");
    const auto& texts = compiled->shaders[0].text;
    for (const char* target : {"glsl-430", "glsl-450", "essl-310", "hlsl-5.0", "hlsl-5.1", "hlsl-6.0"})
      EXPECT_EQ(texts.at(target).find("precise vec4") != std::string::npos ||
                    texts.at(target).find("precise float4") != std::string::npos ||
                    texts.at(target).find("precise highp vec4") != std::string::npos,
                is_precise)
          << texts.at(target);
    EXPECT_EQ(texts.at("essl-310").find("#extension GL_EXT_gpu_shader5 : enable") != std::string::npos, is_precise);
  }
}

TEST(CompileEmit, VaryingsAreNamedByTheStageThatWritesThem) {
  const auto compiled = compile_for(testing::prism_sample(), {"glsl-330"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[0].text.at("glsl-330"), HasSubstr("out vec2 relievo_vertex_out_1;"));
  EXPECT_THAT(compiled->shaders[1].text.at("glsl-330"), HasSubstr("in vec2 relievo_vertex_out_1[3];"));
  EXPECT_THAT(compiled->shaders[1].text.at("glsl-330"), HasSubstr("flat out ivec2 relievo_geometry_out_1;"));
  EXPECT_THAT(compiled->shaders[2].text.at("glsl-330"), HasSubstr("flat in ivec2 relievo_geometry_out_1;"));
}

TEST(CompileEmit, VaryingsOfDifferentNamesMeetByLocation) {
  const ComposedProgram program = testing::fragment_program(R"(
layout(location = 1) in vec2 another_name;
layout(location = 0) out vec4 color;
void main() { color = another_name.xyxy; }
)");
  const auto compiled = compile_for(program, {"glsl-330", "essl-300"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_EQ(testing::check_program(*compiled), "");
  EXPECT_THAT(compiled->shaders[1].text.at("glsl-330"), HasSubstr("in vec2 relievo_vertex_out_1;"));
}

TEST(CompileEmit, OutputsThatNobodyReadsAreNotPartOfTheDirect3DSignature) {
  const auto compiled = compile_for(testing::surface_sample(), {"hlsl-5.0", "msl-2.2", "glsl-450"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const std::string& hlsl = compiled->shaders[0].text.at("hlsl-5.0");
  const std::string outputs = hlsl.substr(hlsl.find("struct SPIRV_Cross_Output"));
  EXPECT_THAT(outputs, Not(HasSubstr("TEXCOORD0")));
  EXPECT_THAT(outputs, HasSubstr("world_uv : TEXCOORD1"));
  EXPECT_THAT(compiled->shaders[0].text.at("msl-2.2"), Not(HasSubstr("[[user(locn0)]]")));
}

TEST(CompileEmit, InstanceIndexNeedsNoBaseInstance) {
  const auto compiled = compile_for(testing::surface_sample(), {"glsl-330", "glsl-450", "essl-300", "hlsl-5.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  for (const auto& [name, text] : compiled->shaders[0].text) {
    EXPECT_THAT(text, Not(HasSubstr("BaseInstance"))) << name;
    EXPECT_THAT(text, Not(HasSubstr("BaseVertex"))) << name;
    EXPECT_THAT(text, Not(HasSubstr("#extension"))) << name;
  }
}

TEST(CompileEmit, ClipSpaceIsLeftToTheRuntime) {
  const auto compiled = compile_for(testing::surface_sample(), {"glsl-330", "essl-300", "hlsl-5.0", "msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  for (const auto& [name, text] : compiled->shaders[0].text) {
    EXPECT_THAT(text, Not(HasSubstr("gl_Position.z"))) << name;
    EXPECT_THAT(text, Not(HasSubstr("gl_Position.y"))) << name;
  }
}

TEST(CompileEmit, TextureQueryLodReachesMetal) {
  const auto compiled = compile_for(testing::fragment_program(R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
void main() { color = vec4(textureQueryLod(map, uv), 0.0, 1.0); }
)"),
                                    {"msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[1].text.at("msl-2.2"), HasSubstr("calculate_clamped_lod"));
}

TEST(CompileEmit, WhatSpirvCrossThrowsIsAnErrorThatNamesTargetAndPermutation) {
  const auto compiled = compile_for(testing::compute_program(R"(
layout(push_constant) uniform Push { float packed_tightly[3]; } push;
layout(set = 2, binding = 0, std430) buffer Output { float data[]; } result;
void main() { result.data[0] = push.packed_tightly[gl_LocalInvocationID.x % 3]; }
)"),
                                    {"hlsl-5.0"});
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().id, "compile.emit");
  EXPECT_EQ(exit_code(compiled.error().code), 2);
  EXPECT_THAT(compiled.error().message, HasSubstr("hlsl-5.0 of the compute shader"));
  EXPECT_THAT(compiled.error().message, HasSubstr("sample/view=relief"));
}

TEST(CompileEmit, TheGlslCheckCatchesASeededFault) {
  auto compiled = compile_for(testing::surface_sample(), {"glsl-330"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  CompiledProgram broken = *compiled;
  std::string& text = broken.shaders[1].text.at("glsl-330");
  text.replace(text.find("void main()"), 0, "layout(binding = 0) uniform sampler2D needs_420;\n");
  EXPECT_NE(testing::check_program(broken), "");
}

TEST(CompileEmit, TheGlslCheckComparesVaryingsAcrossStages) {
  auto compiled = compile_for(testing::surface_sample(), {"glsl-330"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  std::string& text = compiled->shaders[1].text.at("glsl-330");
  text.replace(text.find("in vec2 relievo_vertex_out_1"), 7, "in vec3");
  EXPECT_NE(testing::check_program(*compiled), "");
}

TEST(CompileEmit, TheGlslCheckCatchesAVaryingThatNobodyWrites) {
  auto compiled = compile_for(testing::surface_sample(), {"essl-300"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  std::string& text = compiled->shaders[1].text.at("essl-300");
  const std::string name = "relievo_vertex_out_1";
  for (std::size_t at; (at = text.find(name)) != std::string::npos;)
    text.replace(at, name.size(), "relievo_lost_out_1");
  EXPECT_EQ(testing::check_program(*compiled), "'relievo_lost_out_1' is read and never written");
}

TEST(CompileEmit, TheHlslCheckCatchesASeededFault) {
  auto compiled = compile_for(testing::ray_sample(), {"hlsl-5.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  std::string& text = compiled->shaders[0].text.at("hlsl-5.0");
  text.replace(text.find("relievo_height_map.Load("), 18, "relievo_height_mop");
  EXPECT_NE(testing::check_program(*compiled), "");
}

TEST(CompileEmit, TheSpirvCheckCatchesASeededFault) {
  const auto compiled = compile_for(testing::ray_sample(), {});
  ASSERT_TRUE(compiled) << compiled.error().message;
  std::vector<std::uint32_t> words = compiled->shaders[0].spirv;
  EXPECT_EQ(testing::check_spirv(words), "");
  words[1] = 0x00010300u;
  EXPECT_NE(testing::check_spirv(words), "");
  words[1] = 0x00010000u;
  words.pop_back();
  EXPECT_NE(testing::check_spirv(words), "");
}

}  // namespace
}  // namespace relievo
