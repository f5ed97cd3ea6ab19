// Targets of one family share their emission; what each one gets is what it gets alone.
#include <gtest/gtest.h>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

/// Validation changes no text, and takes a fifth of the time.
constexpr CompileOptions kUnvalidated = {true, false, 1};

enum class Refusals { none, some };

/// What each target gets alone; without those that lack a capability for the program. Others may refuse it for what
/// their language lacks, where that is `expected`.
std::vector<std::pair<Target, CompiledProgram>> compile_alone(const ComposedProgram& program,
                                                              Refusals expected = Refusals::some) {
  std::vector<std::pair<Target, CompiledProgram>> all;
  for (const Target& target : all_targets()) {
    if (target.language == Language::spirv || !check_capabilities(target, program, {})) continue;
    auto compiled = compile(program, {{target}}, kUnvalidated);
    if (compiled) all.emplace_back(target, *std::move(compiled));
    EXPECT_TRUE(compiled || expected == Refusals::some) << to_string(target) << ": " << format(compiled.error());
  }
  return all;
}

std::vector<Target> targets_of(const std::vector<std::pair<Target, CompiledProgram>>& alone) {
  std::vector<Target> targets;
  for (const auto& [target, compiled] : alone) targets.push_back(target);
  return targets;
}

/// The first text of `together` that is another than in `alone`; empty when all agree.
std::string find_difference(const CompiledProgram& together, const CompiledProgram& alone, const Target& target) {
  for (std::size_t i = 0; i < together.shaders.size(); ++i) {
    const std::string name = to_string(target);
    if (together.shaders[i].text.at(name) != alone.shaders[i].text.at(name)) {
      return name + " of the " + std::string(to_string(together.shaders[i].stage)) + " shader of " + together.key;
    }
  }
  return {};
}

/// Compiles for all targets at once and for each alone; returns where they differ.
std::string compare_together_and_alone(const ComposedProgram& program, Refusals expected = Refusals::some) {
  const auto all = compile_alone(program, expected);
  if (all.empty()) return "no target takes " + program.key;
  const auto together = compile(program, targets_of(all), kUnvalidated);
  if (!together) return together.error().message;
  for (const auto& [target, alone] : all) {
    if (const std::string where = find_difference(*together, alone, target); !where.empty()) return where;
  }
  return {};
}

TEST(CompileSharedTexts, EveryTechniqueInEveryStageGetsWhatItGetsAlone) {
  const Registry registry = *load_registry();
  std::size_t compared = 0, tracing = 0;
  for (const auto& [stage, stage_descriptor] : registry.stages) {
    const bool traces = !stage_descriptor.roles.empty();
    tracing += traces;
    for (const auto& [technique, descriptor] : registry.techniques) {
      if (technique == "oracle" && stage == "ray") continue;  // it replays hits by the pixel that a fragment has
      SCOPED_TRACE(stage + " with " + technique);
      Permutation permutation;
      permutation.stage = stage;
      for (const std::string& role : stage_descriptor.roles) permutation.roles[role] = technique;
      const auto program = compose(registry, permutation);
      ASSERT_TRUE(program) << format(program.error());
      EXPECT_EQ(compare_together_and_alone(*program, Refusals::none), "");
      ++compared;
      if (!traces) break;  // the same with each
    }
  }
  EXPECT_EQ(compared, tracing * registry.techniques.size() - 1 + (registry.stages.size() - tracing));
  EXPECT_GT(tracing, 1u);
}

TEST(CompileSharedTexts, EveryShapeOfPipelineGetsWhatItGetsAlone) {
  EXPECT_EQ(compare_together_and_alone(testing::ray_sample(), Refusals::none), "");
  EXPECT_EQ(compare_together_and_alone(testing::surface_sample(), Refusals::none), "");
  EXPECT_EQ(compare_together_and_alone(testing::prism_sample(), Refusals::none), "");
  EXPECT_EQ(compare_together_and_alone(testing::tessellation_sample(), Refusals::none), "");
  EXPECT_EQ(compare_together_and_alone(testing::bake_sample(), Refusals::none), "");
}

/// What SPIRV-Cross writes differently from version to version: one expression each, of type vec4.
class CompileSharedTextsOf : public ::testing::TestWithParam<const char*> {};

TEST_P(CompileSharedTextsOf, AnExpressionGetsWhatItGetsAlone) {
  const std::string text = std::string(R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
layout(set = 1, binding = 1) uniform sampler2DArrayShadow shadow;
layout(set = 1, binding = 2) uniform isampler3D volume;
struct Place { vec3 at; float weights[2][3]; };
vec4 twice(vec4 v) { precise vec4 sum = v * v + v; return sum * sum + v; }
void main() {
  Place place = Place(vec3(uv, 1.0), float[2][3](float[3](uv.x, 1.0, 2.0), float[3](3.0, 4.0, uv.y)));
  vec4 here = vec4(uv, uv);
  ivec2 cell = ivec2(uv * 16.0);
  color = )") + GetParam() +
                           ";\n}\n";
  EXPECT_EQ(compare_together_and_alone(testing::fragment_program(text)), "");
}

INSTANTIATE_TEST_SUITE_P(
    Versions, CompileSharedTextsOf,
    ::testing::Values("twice(here)", "fma(here, here, here.wzyx)", "mix(here, here.yxwz, lessThan(here, here.zwxy))",
                      "vec4(dFdxFine(uv.x), dFdyCoarse(uv.y), fwidthFine(uv))", "textureGather(map, uv, 1)",
                      "textureGatherOffset(map, uv, ivec2(1, -1))", "vec4(textureQueryLevels(map))",
                      "vec4(textureQueryLod(map, uv), uv)", "vec4(textureGrad(shadow, here, uv, uv.yx))",
                      "vec4(texelFetch(volume, ivec3(cell, 0), 0))", "vec4(unpackHalf2x16(packHalf2x16(uv)), uv)",
                      "vec4(bitfieldExtract(cell.x, 2, 3), bitCount(cell.y), findMSB(cell.x), 0)",
                      "unpackUnorm4x8(packUnorm4x8(here)) + vec4(intBitsToFloat(cell), uv)",
                      "vec4(place.weights[cell.x & 1][1], place.at)", "vec4(inverse(mat2(here)) * uv, uv)",
                      "vec4(frexp(uv.x, cell.x), ldexp(uv.y, 3), modf(uv.x, here.y), here.y)",
                      "vec4(double(uv.x) * 3.0lf)", "vec4(gl_FragCoord.w, gl_SampleID, gl_FrontFacing, 0)"));

TEST(CompileSharedTexts, AuthorsPrecisionAndBlocksGetWhatTheyGetAlone) {
  EXPECT_EQ(compare_together_and_alone(testing::fragment_program(R"(
layout(location = 1) in mediump vec2 uv;
layout(location = 0) out mediump vec4 color;
layout(set = 0, binding = 1, std140) uniform Tint { layout(row_major) mat3 turn; mediump vec4 tint[2]; };
mediump float half_of(mediump float x) { return x * 0.5; }
void main() {
  mediump vec4 sum = tint[0];
  for (int i = 0, k = 4; i < k; ++i, --k) {
    sum += sum * half_of(uv.x);
    if (sum.x > 3.0) break;
  }
  switch (int(uv.y)) {
    case 0: sum.x += 1.0;
    case 1: sum.y += 1.0; break;
    default: discard;
  }
  highp vec3 turned = turn * vec3(uv, 1.0);
  color = sum * tint[int(uv.x)] + vec4(turned, turned.x);
}
)")),
            "");
}

TEST(CompileSharedTexts, HintsGetWhatTheyGetAlone) {
  EXPECT_EQ(compare_together_and_alone(testing::fragment_program(R"(
#extension GL_EXT_control_flow_attributes : require
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
  vec4 sum = vec4(uv, uv);
  [[dont_unroll]] for (int i = 0; i < 4; ++i) sum += sum.yzwx;
  [[flatten]] if (sum.x > 1.0) sum.y = 0.0;
  color = sum;
}
)")),
            "");
}

/// A vertex shader that passes `passed` as declared, and a fragment shader that reads it.
ComposedProgram passing_program(const std::string& type, const std::string& declaration) {
  ComposedShader vertex, fragment;
  vertex.stage = ShaderStage::vertex;
  vertex.text =
      "#version 450\nlayout(location = 0) in vec4 position;\n" + type + "layout(location = 0) out " + declaration + R"(
void main() {
  passed.uv = position.xy;
  passed.way = position.yzw;
  gl_Position = position;
}
)";
  fragment.stage = ShaderStage::fragment;
  fragment.text = "#version 450\nlayout(location = 0) out vec4 color;\n" + type + "layout(location = 0) in " +
                  declaration + "\nvoid main() { color = vec4(passed.uv, passed.way.xy); }\n";
  return testing::make_program({vertex, fragment});
}

TEST(CompileSharedTexts, VaryingBlocksGetWhatTheyGetAlone) {
  EXPECT_EQ(compare_together_and_alone(passing_program("", "Passed { vec2 uv; vec3 way; } passed;")), "");
}

TEST(CompileSharedTexts, VaryingStructsGetWhatTheyGetAlone) {
  EXPECT_EQ(compare_together_and_alone(passing_program("struct Passed { vec2 uv; vec3 way; };\n", "Passed passed;")),
            "");
}

TEST(CompileSharedTexts, ThreadsChangeNothing) {
  CompileOptions options;
  for (const ComposedProgram& program : {testing::surface_sample(), testing::prism_sample()}) {
    const std::vector<Target> targets = targets_of(compile_alone(program));
    const auto expected = compile(program, targets);
    ASSERT_TRUE(expected) << expected.error().message;
    for (int repeat = 0; repeat < 20; ++repeat) {
      options.threads = 2 + static_cast<unsigned>(repeat % 3);
      const auto compiled = compile(program, targets, options);
      ASSERT_TRUE(compiled) << compiled.error().message;
      EXPECT_EQ(compiled->reflection, expected->reflection);
      for (std::size_t i = 0; i < expected->shaders.size(); ++i) {
        EXPECT_EQ(compiled->shaders[i].spirv, expected->shaders[i].spirv);
        EXPECT_EQ(compiled->shaders[i].text, expected->shaders[i].text);
      }
    }
  }
}

TEST(CompileSharedTexts, TheComparisonCatchesAForeignText) {
  const auto program = testing::surface_sample();
  const Target target = *parse_target("hlsl-5.1");
  const auto alone = compile(program, {{target}});
  ASSERT_TRUE(alone) << alone.error().message;
  auto together = *compile(program, all_targets());
  EXPECT_EQ(find_difference(together, *alone, target), "");
  together.shaders[1].text["hlsl-5.1"] = together.shaders[1].text["hlsl-5.0"];
  EXPECT_NE(find_difference(together, *alone, target), "");
}

}  // namespace
}  // namespace relievo
