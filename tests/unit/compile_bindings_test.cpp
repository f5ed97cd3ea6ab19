#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compile/binding_collisions.hpp"
#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"
#include "support/target_checks.hpp"

namespace relievo {
namespace {

using testing::compute_program;
using testing::fragment_program;
using ::testing::HasSubstr;
using ::testing::Not;

Result<CompiledProgram> compile_for(const ComposedProgram& program, std::initializer_list<const char*> names) {
  std::vector<Target> targets;
  for (const char* name : names) targets.push_back(*parse_target(name));
  return compile(program, targets);
}

/// Four kinds of resource at binding 0 of different sets, and two of one kind.
ComposedProgram crowded_sets() {
  return compute_program(R"(
layout(set = 0, binding = 0, std140) uniform Alpha { vec4 a; } alpha;
layout(set = 1, binding = 0, std140) uniform Beta { vec4 b; } beta;
layout(set = 2, binding = 0) uniform sampler2D gamma_map;
layout(set = 3, binding = 0) uniform sampler2D delta_map;
layout(set = 4, binding = 0, std430) readonly buffer Epsilon { vec4 data[]; } epsilon;
layout(set = 5, binding = 0, std430) buffer Zeta { vec4 data[]; } zeta;
layout(set = 6, binding = 0, r32f) uniform writeonly image2D eta;
void main() {
  vec4 sum = alpha.a + beta.b + textureLod(gamma_map, vec2(0.5), 0.0) + textureLod(delta_map, vec2(0.5), 0.0);
  zeta.data[0] += sum + epsilon.data[0];
  imageStore(eta, ivec2(0), sum);
}
)");
}

TEST(CompileBindings, SetsThatShareABindingGetRegistersOfTheirOwnOnEveryShaderModel) {
  const auto compiled = compile_for(crowded_sets(), {"hlsl-5.0", "hlsl-5.1", "hlsl-6.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const std::string& sm50 = compiled->shaders[0].text.at("hlsl-5.0");
  for (const char* declaration :
       {"cbuffer Alpha : register(b0)", "cbuffer Beta : register(b1)", "gamma_map : register(t0)",
        "_gamma_map_sampler : register(s0)", "delta_map : register(t1)", "_delta_map_sampler : register(s1)",
        "ByteAddressBuffer epsilon : register(t2)", "RWByteAddressBuffer zeta : register(u0)", "eta : register(u1)"}) {
    EXPECT_THAT(sm50, HasSubstr(declaration));
  }
  EXPECT_THAT(compiled->shaders[0].text.at("hlsl-6.0"), HasSubstr("cbuffer Beta : register(b1, space0)"));
}

TEST(CompileBindings, MetalIndicesFollowSetAndBinding) {
  const auto compiled = compile_for(crowded_sets(), {"msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const std::string& text = compiled->shaders[0].text.at("msl-2.2");
  for (const char* declaration :
       {"Alpha& alpha [[buffer(0)]]", "Beta& beta [[buffer(1)]]", "Epsilon& epsilon [[buffer(2)]]",
        "Zeta& zeta [[buffer(3)]]", "gamma_map [[texture(0)]]", "delta_map [[texture(1)]]", "eta [[texture(2)]]",
        "gamma_mapSmplr [[sampler(0)]]", "delta_mapSmplr [[sampler(1)]]"}) {
    EXPECT_THAT(text, HasSubstr(declaration));
  }
}

TEST(CompileBindings, OpenGlSlotsAreDenseInTheNamespaceOfTheirKind) {
  const auto compiled = compile_for(crowded_sets(), {"glsl-450"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const std::vector<std::pair<std::string, int>> expected = {
      {"Alpha", 0}, {"Beta", 1}, {"gamma_map", 0}, {"delta_map", 1}, {"Epsilon", 0}, {"Zeta", 1}, {"eta", 0}};
  ASSERT_EQ(compiled->bindings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(compiled->bindings[i].name, expected[i].first);
    EXPECT_EQ(compiled->bindings[i].gl_slot, expected[i].second) << expected[i].first;
    EXPECT_EQ(compiled->bindings[i].set, static_cast<int>(i));
  }
  const std::string& text = compiled->shaders[0].text.at("glsl-450");
  for (const char* declaration :
       {"layout(binding = 1, std140) uniform Beta", "layout(binding = 1) uniform sampler2D delta_map",
        "layout(binding = 0, std430) readonly buffer Epsilon", "layout(binding = 1, std430) buffer Zeta",
        "layout(binding = 0, r32f) uniform writeonly image2D eta"}) {
    EXPECT_THAT(text, HasSubstr(declaration));
  }
}

TEST(CompileBindings, StagesAgreeOnSlotsThoughEachUsesADifferentPart) {
  ComposedProgram program = fragment_program(R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 1, std140) uniform Light { vec4 color; } light;
layout(set = 1, binding = 2) uniform sampler2D late_map;
void main() { color = light.color * textureLod(late_map, uv, 0.0); }
)");
  program.shaders[0].text = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) out vec2 uv;
layout(set = 0, binding = 0, std140) uniform Camera { mat4 clip_from_world; } camera;
layout(set = 1, binding = 0) uniform sampler2D early_map;
void main() {
  uv = position.xy;
  gl_Position = camera.clip_from_world * vec4(position + textureLod(early_map, uv, 0.0).x, 1.0);
}
)";
  const auto compiled = compile_for(program, {"glsl-330", "glsl-450", "essl-300", "hlsl-5.0", "msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[1].text.at("glsl-450"), HasSubstr("layout(binding = 1, std140) uniform Light"));
  EXPECT_THAT(compiled->shaders[1].text.at("glsl-450"), HasSubstr("layout(binding = 1) uniform sampler2D late_map"));
  EXPECT_THAT(compiled->shaders[1].text.at("hlsl-5.0"), HasSubstr("cbuffer Light : register(b1)"));
  EXPECT_THAT(compiled->shaders[1].text.at("msl-2.2"), HasSubstr("late_map [[texture(1)]]"));
  for (const char* target : {"glsl-330", "essl-300"}) {
    EXPECT_THAT(compiled->shaders[1].text.at(target), HasSubstr("uniform Light\n")) << target;
    EXPECT_THAT(compiled->shaders[1].text.at(target), Not(HasSubstr("binding ="))) << target;
  }
  EXPECT_EQ(testing::check_program(*compiled), "");
}

TEST(CompileBindings, TellsWhatIsSampledFromWhatIsOnlyFetched) {
  ComposedProgram program = fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) uniform sampler2D sampled;
layout(set = 0, binding = 1) uniform sampler2D fetched;
layout(set = 0, binding = 2) uniform sampler2D gathered;
layout(set = 0, binding = 3) uniform sampler2D passed_on;
layout(set = 0, binding = 4) uniform sampler2D passed_and_fetched;
layout(set = 0, binding = 5) uniform sampler3D graded;
layout(set = 0, binding = 6) uniform sampler2D in_another_stage;
layout(set = 0, binding = 7) uniform sampler2D several[2];
vec4 twice(sampler2D map) { return texture(map, vec2(0.5)) + texture(map, vec2(0.25)); }
vec4 once_more(sampler2D map) { return twice(map) * 0.5; }
vec4 first(sampler2D map) { return texelFetch(map, ivec2(0), 0); }
void main() {
  color = texture(sampled, vec2(0.5)) + texelFetch(fetched, ivec2(0), 0) + textureGather(gathered, vec2(0.5));
  color += once_more(passed_on) + first(passed_and_fetched) + vec4(textureSize(fetched, 0).x);
  color += textureGrad(graded, vec3(0.5), vec3(0.1), vec3(0.1)) + texelFetch(in_another_stage, ivec2(1), 0);
  color += texture(several[1], vec2(0.5));
}
)");
  program.shaders[0].text = R"(#version 450
layout(set = 0, binding = 6) uniform sampler2D in_another_stage;
void main() { gl_Position = textureLod(in_another_stage, vec2(0.5), 0.0); }
)";
  for (const bool optimize : {true, false}) {
    CompileOptions options;
    options.optimize = optimize;
    const auto compiled = compile(program, {}, options);
    ASSERT_TRUE(compiled) << compiled.error().message;
    std::vector<bool> filtered;
    for (const BindingSlot& slot : compiled->bindings) filtered.push_back(slot.is_filtered);
    EXPECT_THAT(filtered, ::testing::ElementsAre(true, false, false, true, false, true, true, true));
    const auto reflection = nlohmann::json::parse(compiled->reflection);
    EXPECT_EQ(reflection["bindings"][1]["filtered"], false);
    EXPECT_EQ(reflection["bindings"][3]["filtered"], true);
  }
}

TEST(CompileBindings, PushConstantsArePinnedAfterTheUniformBlocks) {
  const auto compiled = compile_for(compute_program(R"(
layout(set = 0, binding = 0, std140) uniform Parameters { vec4 a; } parameters;
layout(set = 2, binding = 0, std430) buffer Output { vec4 data[]; } result;
layout(push_constant) uniform Push { vec4 offset; int count; } push;
void main() { result.data[push.count] = parameters.a + push.offset; }
)"),
                                    {"glsl-450", "essl-310", "hlsl-5.0", "hlsl-6.0", "msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  const auto& text = compiled->shaders[0].text;
  EXPECT_THAT(text.at("hlsl-5.0"), HasSubstr("cbuffer Push : register(b1)"));
  EXPECT_THAT(text.at("hlsl-6.0"), HasSubstr("cbuffer Push : register(b1, space0)"));
  EXPECT_THAT(text.at("glsl-450"), HasSubstr("layout(binding = 1, std140) uniform Push"));
  EXPECT_THAT(text.at("msl-2.2"), HasSubstr("Push& push [[buffer(2)]]"));
  const auto json = nlohmann::json::parse(compiled->reflection);
  EXPECT_EQ(json["push_constants"]["size"], 20);
  EXPECT_EQ(json["push_constants"]["targets"]["hlsl-5.0"]["register"], "b1");
  EXPECT_EQ(testing::check_program(*compiled), "");
}

TEST(CompileBindings, WritableRegistersFollowTheRenderTargets) {
  const auto compiled = compile_for(fragment_program(R"(
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal;
layout(set = 2, binding = 0, std430) buffer Counters { uint data[]; } counters;
void main() { color = normal = vec4(1.0); counters.data[0] = 1u; }
)"),
                                    {"hlsl-5.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[1].text.at("hlsl-5.0"), HasSubstr("counters : register(u2)"));
}

TEST(CompileBindings, AnArrayOfTexturesTakesConsecutiveSlots) {
  const auto compiled = compile_for(compute_program(R"(
layout(set = 1, binding = 0) uniform sampler2D many[3];
layout(set = 1, binding = 1) uniform sampler2D last;
layout(set = 2, binding = 0, std430) buffer Output { vec4 data[]; } result;
void main() { result.data[0] = textureLod(many[2], vec2(0.5), 0.0) + textureLod(last, vec2(0.5), 0.0); }
)"),
                                    {"glsl-450", "hlsl-5.0", "msl-2.2"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_THAT(compiled->shaders[0].text.at("glsl-450"), HasSubstr("layout(binding = 3) uniform sampler2D last"));
  EXPECT_THAT(compiled->shaders[0].text.at("hlsl-5.0"), HasSubstr("last : register(t3)"));
  EXPECT_THAT(compiled->shaders[0].text.at("msl-2.2"), HasSubstr("last [[texture(3)]]"));
}

TEST(CompileBindings, AnUnusedResourceCostsNoBinding) {
  const auto compiled = compile_for(compute_program(R"(
layout(set = 1, binding = 0) uniform sampler2D unused_map;
layout(set = 2, binding = 0, std430) buffer Output { vec4 data[]; } result;
void main() { result.data[0] = vec4(1.0); }
)"),
                                    {"glsl-450", "hlsl-5.0"});
  ASSERT_TRUE(compiled) << compiled.error().message;
  ASSERT_EQ(compiled->bindings.size(), 1U);
  EXPECT_EQ(compiled->bindings[0].name, "Output");
  EXPECT_THAT(compiled->shaders[0].text.at("hlsl-5.0"), Not(HasSubstr("unused_map")));
}

TEST(CompileBindings, StagesThatDisagreeAboutABindingAreAnError) {
  ComposedProgram program = fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) uniform sampler2D map;
void main() { color = textureLod(map, vec2(0.5), 0.0); }
)");
  const auto compiled = compile_for(program, {"glsl-450"});
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().id, "compile.binding-collision");
  EXPECT_THAT(compiled.error().message, HasSubstr("set 0 binding 0"));
  EXPECT_THAT(compiled.error().message, HasSubstr("'Parameters'"));
  EXPECT_THAT(compiled.error().message, HasSubstr("'map'"));
}

TEST(CompileBindings, OneNameAtTwoBindingsIsAnError) {
  ComposedProgram program = fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 3, binding = 1) uniform sampler2D relievo_map;
void main() { color = textureLod(relievo_map, vec2(0.5), 0.0); }
)");
  program.shaders[0].text = R"(#version 450
layout(location = 0) in vec3 position;
layout(set = 3, binding = 0) uniform sampler2D relievo_map;
void main() { gl_Position = textureLod(relievo_map, position.xy, 0.0); }
)";
  const auto compiled = compile_for(program, {"glsl-330"});
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().id, "compile.glsl");
  EXPECT_THAT(compiled.error().message, HasSubstr("Layout binding qualifier must match"));
}

TEST(CompileBindings, SeparateTexturesAreOutsideTheContract) {
  const auto compiled = compile_for(fragment_program(R"(
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform texture2D lone_texture;
layout(set = 1, binding = 1) uniform sampler lone_sampler;
void main() { color = textureLod(sampler2D(lone_texture, lone_sampler), vec2(0.5), 0.0); }
)"),
                                    {"glsl-450"});
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().id, "compile.binding-kind");
  EXPECT_THAT(compiled.error().message, HasSubstr("'lone_texture'"));
}

TEST(CompileBindings, TheCollisionCheckCatchesSeededCollisions) {
  EXPECT_EQ(find_binding_collision(Language::hlsl, "cbuffer A : register(b0)\n{\n};\ncbuffer B : register(b0)\n"),
            "b0");
  EXPECT_EQ(
      find_binding_collision(Language::hlsl, "Texture2D a : register(t1, space0);\nTexture2D b : register(t1);\n"),
      "t1");
  EXPECT_EQ(
      find_binding_collision(
          Language::glsl, "layout(binding = 2) uniform sampler2D a;\nlayout(binding = 2) uniform highp sampler3D b;\n"),
      "texture unit 2");
  EXPECT_EQ(find_binding_collision(Language::essl,
                                   "layout(binding = 0, std430) readonly buffer A\n{\n} a;\n"
                                   "layout(binding = 0, std430) buffer B\n"),
            "storage block 0");
  EXPECT_EQ(find_binding_collision(Language::msl,
                                   "kernel void main0(constant A& a [[buffer(0)]], device B& b [[buffer(0)]])"),
            "buffer(0)");
}

TEST(CompileBindings, TheCollisionCheckKeepsNamespacesApart) {
  EXPECT_EQ(find_binding_collision(Language::hlsl,
                                   "x : register(t0);\ny : register(s0);\nz : register(u0);\nw : register(b0)\n"),
            "");
  EXPECT_EQ(find_binding_collision(
                Language::glsl,
                "layout(binding = 0, std140) uniform A\nlayout(binding = 0) uniform sampler2D b;\n"
                "layout(binding = 0, r32f) uniform writeonly image2D c;\nlayout(binding = 0, std430) buffer D\n"),
            "");
  EXPECT_EQ(find_binding_collision(Language::msl, "a [[buffer(0)]], b [[texture(0)]], c [[sampler(0)]]"), "");
}

}  // namespace
}  // namespace relievo
