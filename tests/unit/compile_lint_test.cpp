#include <gtest/gtest.h>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

/// Compiles a fragment shader whose helper is at techniques/relief/relief.glsl:40 and whose main is at stage.glsl:1.
Error lint(const std::string& helper, const std::string& body) {
  const auto compiled = compile(testing::fragment_program(R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
#line 40 "techniques/relief/relief.glsl"
)" + helper + R"(
#line 1 "stage.glsl"
void main() { color = vec4(0.0); )" + body + " }"),
                                {});
  return compiled ? Error{} : compiled.error();
}

TEST(CompileLint, TextureInsideALoopIsAnError) {
  const Error error = lint("", "for (int i = 0; i < 4; ++i) { color += texture(map, uv); }");
  EXPECT_EQ(error.id, "lint.implicit-lod-in-loop");
  EXPECT_EQ(error.code, ErrorCode::compile);
  EXPECT_EQ(error.file, "stage.glsl");
  EXPECT_EQ(error.line, 1);
  EXPECT_NE(error.message.find("'texture'"), std::string::npos);
  EXPECT_NE(error.message.find("sample/view=relief"), std::string::npos);
}

TEST(CompileLint, AFunctionThatALoopCallsIsLintedAtItsOwnLine) {
  const Error error =
      lint("float inner(vec2 p) {\n  return texture(map, p).x; }\nfloat outer(vec2 p) { return inner(p); }",
           "for (int i = 0; i < 4; ++i) color.x += outer(uv);");
  EXPECT_EQ(error.id, "lint.implicit-lod-in-loop");
  EXPECT_EQ(error.file, "techniques/relief/relief.glsl");
  EXPECT_EQ(error.line, 41);
}

TEST(CompileLint, EveryKindOfLoopAndDerivativeIsSeen) {
  for (const char* body : {
           "int i = 0; while (i++ < 4) color += texture(map, uv);",
           "int i = 0; do color += texture(map, uv); while (i++ < 4);",
           "for (int i = 0; i < 4; ++i) { if (uv.x > 0.5) { color += texture(map, uv); break; } }",
           "for (int i = 0; i < 4; ++i) { switch (i) { case 1: color += texture(map, uv); break; default: break; } }",
           "for (int i = 0; texture(map, uv).x > float(i); ++i) color += 1.0;",
           "for (int i = 0; i < 4; i += int(texture(map, uv).x)) color += 1.0;",
           "for (int i = 0; i < 4; ++i) color += textureProj(map, vec3(uv, 1.0));",
           "for (int i = 0; i < 4; ++i) color.xy += textureQueryLod(map, uv);",
           "for (int i = 0; i < 4; ++i) color.x += dFdx(uv.x * float(i));",
           "for (int i = 0; i < 4; ++i) color.x += dFdy(uv.x * float(i));",
           "for (int i = 0; i < 4; ++i) color.x += fwidth(uv.x * float(i));",
       }) {
    EXPECT_EQ(lint("", body).id, "lint.implicit-lod-in-loop") << body;
  }
}

TEST(CompileLint, ExplicitLodAndGradientsInLoopsPass) {
  EXPECT_EQ(
      lint("", "for (int i = 0; i < 4; ++i) color += textureLod(map, uv, 0.0) + texelFetch(map, ivec2(i), 0);").id, "");
  EXPECT_EQ(lint("", "vec2 d = dFdx(uv); for (int i = 0; i < 4; ++i) color += textureGrad(map, uv, d, d);").id, "");
}

TEST(CompileLint, ImplicitLodBeforeAndAfterALoopPasses) {
  EXPECT_EQ(lint("float f(vec2 p) { return texture(map, p).x; }",
                 "color += f(uv); for (int i = 0; i < 4; ++i) color += 1.0; color += texture(map, uv) + f(uv);")
                .id,
            "");
}

}  // namespace
}  // namespace relievo
