// Which parameters are passed as values, seen in the emitted text: a copy is a variable `param`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The GLSL of a fragment shader with this function, called once; its varying is `uv`, as its author wrote it.
std::string text_of(const std::string& function, const std::string& call) {
  const auto program =
      testing::fragment_program("layout(location = 1) in vec2 uv;\nlayout(location = 0) out vec4 color;\n" + function +
                                "\nvoid main() { color = vec4(" + call + "); }\n");
  const auto compiled = compile(program, {{*parse_target("glsl-450")}});
  if (!compiled) return format(compiled.error());
  std::string text = compiled->shaders.back().text.at("glsl-450");
  constexpr std::string_view emitted = "relievo_vertex_out_1";
  for (std::size_t at = 0; (at = text.find(emitted, at)) != std::string::npos;) text.replace(at, emitted.size(), "uv");
  return text;
}

TEST(CompileConstantParameters, WhatIsOnlyReadIsPassedAsAValue) {
  const std::string text = text_of(
      "struct P { vec2 at; float h; };\n"
      "float f(P p, vec2 v, int i) { return p.at.x * v[i] + max(p.h, v.y); }",
      "f(P(uv, 1.0), uv, int(uv.x))");
  EXPECT_THAT(text, HasSubstr("f(P(uv, 1.0), uv, int(uv.x))"));
  EXPECT_THAT(text, Not(HasSubstr("param")));
}

TEST(CompileConstantParameters, WhatIsWrittenIsPassedAsACopy) {
  for (const char* function :
       {"float f(float x) { x = 1.0 - x; return x * x; }", "float f(float x) { x += uv.y; return x * x; }",
        "float f(float x) { while (x < 1.0) ++x; return x; }", "float f(float x) { return x++ + x; }",
        "float f(float x) { return modf(uv.y, x) + x; }",
        "void g(inout float y) { y *= uv.y; } float f(float x) { g(x); return x; }",
        "void g(out float y) { y = uv.y; } float f(float x) { g(x); return x; }"}) {
    EXPECT_THAT(text_of(function, "f(uv.x)"), HasSubstr("f(param)")) << function;
  }
}

TEST(CompileConstantParameters, OneParameterDoesNotDecideForAnother) {
  EXPECT_THAT(text_of("float f(float x, float y) { x += y; return x * x; }", "f(uv.x, uv.y)"),
              HasSubstr("f(param, uv.y)"));
  EXPECT_THAT(text_of("float f(float x) { x += 1.0; return x; } float f(vec2 x) { return x.x; }", "f(uv)"),
              HasSubstr("f(uv)"));
}

TEST(CompileConstantParameters, ArraysAndMatricesStayVariables) {
  EXPECT_THAT(text_of("float f(float x[2], int i) { return x[i]; }", "f(float[2](uv.x, uv.y), int(uv.x))"),
              HasSubstr("f(param, int(uv.x))"));
  EXPECT_THAT(text_of("float f(mat2 m, int i) { return m[i].x; }", "f(mat2(uv, uv), int(uv.x))"),
              HasSubstr("f(param, int(uv.x))"));
}

TEST(CompileConstantParameters, WhatTheAuthorDeclaredStaysAsItIs) {
  EXPECT_THAT(text_of("float f(const float x, in float y, inout float z) { z += x; return y; }\n"
                      "float g(float z) { return f(uv.x, uv.y, z) + z; }",
                      "g(uv.x)"),
              HasSubstr("f(uv.x, uv.y, "));
}

}  // namespace
}  // namespace relievo
