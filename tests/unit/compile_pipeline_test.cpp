#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <thread>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

std::vector<Target> targets_with_compute() {
  std::vector<Target> targets;
  for (const Target& target : all_targets()) {
    if (to_string(target) != "glsl-330" && to_string(target) != "essl-300") targets.push_back(target);
  }
  return targets;
}

bool same(const CompiledProgram& a, const CompiledProgram& b) {
  if (a.shaders.size() != b.shaders.size() || a.reflection != b.reflection) return false;
  for (std::size_t i = 0; i < a.shaders.size(); ++i) {
    if (a.shaders[i].spirv != b.shaders[i].spirv || a.shaders[i].text != b.shaders[i].text) return false;
  }
  return true;
}

TEST(CompilePipeline, ConcurrentCallsGiveTheBytesOfSequentialOnes) {
  const auto targets = targets_with_compute();
  const auto expected_ray = compile(testing::ray_sample(), targets);
  const auto expected_bake = compile(testing::bake_sample(), targets);
  ASSERT_TRUE(expected_ray && expected_bake);
  EXPECT_FALSE(same(*expected_ray, *expected_bake));
  const auto work = [&](const ComposedProgram& program, const CompiledProgram& expected, int& matches) {
    for (int i = 0; i < 5; ++i) {
      const auto compiled = compile(program, targets);
      if (compiled && same(*compiled, expected)) ++matches;
    }
  };
  int ray_matches = 0, bake_matches = 0;
  std::thread ray([&] { work(testing::ray_sample(), *expected_ray, ray_matches); });
  std::thread bake([&] { work(testing::bake_sample(), *expected_bake, bake_matches); });
  ray.join();
  bake.join();
  EXPECT_EQ(ray_matches, 5);
  EXPECT_EQ(bake_matches, 5);
}

TEST(CompilePipeline, SpirvIsAlwaysMadeAndIsVersion10WithoutLines) {
  for (const bool optimize : {true, false}) {
    const auto compiled = compile(testing::prism_sample(), {}, {optimize, true});
    ASSERT_TRUE(compiled) << compiled.error().message;
    ASSERT_EQ(compiled->shaders.size(), 3U);
    for (const CompiledShader& shader : compiled->shaders) {
      ASSERT_GT(shader.spirv.size(), 5U);
      EXPECT_EQ(shader.spirv[0], 0x07230203u);
      EXPECT_EQ(shader.spirv[1], 0x00010000u);
      EXPECT_TRUE(shader.text.empty());
      for (std::size_t at = 5; at < shader.spirv.size(); at += shader.spirv[at] >> 16) {
        EXPECT_NE(shader.spirv[at] & 0xffffu, 8u) << "OpLine";
        ASSERT_NE(shader.spirv[at] >> 16, 0u);
      }
    }
  }
}

TEST(CompilePipeline, TheOptimizerShrinksTheModule) {
  const auto plain = compile(testing::ray_sample(), {}, {false, true});
  const auto optimized = compile(testing::ray_sample(), {}, {true, true});
  ASSERT_TRUE(plain && optimized);
  EXPECT_LT(optimized->shaders[0].spirv.size(), plain->shaders[0].spirv.size());
}

TEST(CompilePipeline, AProgramWithoutShadersOrWithTwoOfAStageIsAnError) {
  EXPECT_EQ(compile(testing::make_program({}), {}).error().id, "compile.shaders");
  ComposedProgram twice = testing::ray_sample();
  twice.shaders.push_back(twice.shaders[0]);
  EXPECT_EQ(compile(twice, {}).error().id, "compile.shaders");
}

TEST(CompilePipeline, TheJobFormCarriesSpecializationValuesAsBits) {
  const ComposedProgram composed = testing::ray_sample();
  const auto compiled = compile(composed, targets_with_compute());
  ASSERT_TRUE(compiled) << compiled.error().message;
  const ShaderProgram program = to_shader_program(composed, *compiled);
  EXPECT_EQ(program.name, composed.key);
  ASSERT_EQ(program.shaders.size(), 1U);
  EXPECT_EQ(program.shaders[0].spirv, compiled->shaders[0].spirv);
  EXPECT_EQ(program.shaders[0].text, compiled->shaders[0].text);
  ASSERT_EQ(program.bindings.size(), 4U);
  ASSERT_EQ(program.constants.size(), 2U);
  EXPECT_EQ(program.constants[0].id, 0u);
  EXPECT_EQ(program.constants[0].bits, 40u);
  EXPECT_EQ(program.constants[1].id, 1u);
  EXPECT_EQ(program.constants[1].bits, std::bit_cast<std::uint32_t>(0.125F));
}

TEST(CompilePipeline, NegativeIntegersKeepTheirBits) {
  ComposedProgram composed = testing::ray_sample();
  composed.parameters[0].value = -3;
  const auto compiled = compile(composed, {});
  ASSERT_TRUE(compiled);
  EXPECT_EQ(to_shader_program(composed, *compiled).constants[0].bits, 0xfffffffdu);
}

TEST(CompileReflection, TheContractSaysWhereEachResourceLivesOnEachTarget) {
  const auto compiled = compile(testing::ray_sample(), targets_with_compute());
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto json = nlohmann::json::parse(compiled->reflection);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["key"], "sample/view=relief");
  EXPECT_EQ(json["parameter_block_size"], 80);
  const auto& map = json["bindings"][1];
  EXPECT_EQ(map["name"], "relievo_height_map");
  EXPECT_EQ(map["kind"], "sampled_texture");
  EXPECT_EQ(map["targets"]["hlsl-5.0"]["register"], "t0");
  EXPECT_EQ(map["targets"]["hlsl-5.0"]["sampler_register"], "s0");
  EXPECT_EQ(map["targets"]["msl-2.2"]["texture"], 0);
  EXPECT_EQ(map["targets"]["glsl-450"]["slot"], 0);
  EXPECT_EQ(map["targets"]["spirv-1.0"]["set"], 1);
  EXPECT_EQ(json["shaders"][0]["local_size"], nlohmann::json({64, 1, 1}));
  EXPECT_EQ(json["targets"]["msl-2.2"]["entry_point"], "main0");
  EXPECT_EQ(json["maps"][0]["map"], "height");
}

TEST(CompileReflection, ConstantsAndParametersCarryNamesAndDefaults) {
  const auto compiled = compile(testing::ray_sample(), {});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto json = nlohmann::json::parse(compiled->reflection);
  const auto& constant = json["specialization_constants"][0];
  EXPECT_EQ(constant["constant_id"], 0);
  EXPECT_EQ(constant["name"], "relief_linear_steps");
  EXPECT_EQ(constant["type"], "int");
  EXPECT_EQ(constant["default"], 16);
  EXPECT_EQ(json["specialization_constants"][1]["default"], 0.25);
  EXPECT_EQ(json["parameters"][0]["constant_id"], 0);
  EXPECT_EQ(json["parameters"][0]["value"], 40);
  EXPECT_EQ(json["parameters"][2]["offset"], 64);
  EXPECT_EQ(json["parameters"][2]["binding"], "uniform");
}

TEST(CompileReflection, GeometryShadersSayTheirPrimitivesAndLimits) {
  const auto compiled = compile(testing::prism_sample(), {});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto geometry = nlohmann::json::parse(compiled->reflection)["shaders"][1]["geometry"];
  EXPECT_EQ(geometry["input_primitive"], "triangles");
  EXPECT_EQ(geometry["output_primitive"], "triangle_strip");
  EXPECT_EQ(geometry["max_vertices"], 9);
  EXPECT_EQ(geometry["invocations"], 1);
}

TEST(CompileReflection, SpirvCrossesOwnKeysAreKept) {
  const auto compiled = compile(testing::ray_sample(), {});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto cross = nlohmann::json::parse(compiled->reflection)["shaders"][0]["spirv_cross"];
  EXPECT_EQ(cross["entryPoints"][0]["mode"], "comp");
  EXPECT_EQ(cross["textures"][0]["name"], "relievo_height_map");
  EXPECT_EQ(cross["ubos"][0]["name"], "Parameters");
  EXPECT_EQ(cross["ssbos"].size(), 2U);
}

}  // namespace
}  // namespace relievo
