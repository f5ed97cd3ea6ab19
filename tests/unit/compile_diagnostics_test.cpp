#include "compile/diagnostics.hpp"

#include <gtest/gtest.h>

#include "compile/complexity.hpp"
#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

using testing::compute_program;

Error error_of(const ComposedProgram& program) {
  const auto compiled = compile(program, {});
  return compiled ? Error{} : compiled.error();
}

TEST(CompileDiagnostics, AnErrorNamesTheAuthorsFileAndLineAndThePermutation) {
  const Error error = error_of(compute_program(R"(
#line 12 "techniques/relief/relief.glsl"
float relief_trace() { return missing; }
#line 3 "shaders/stages/ray.glsl"
void main() {}
)"));
  EXPECT_EQ(error.code, ErrorCode::compile);
  EXPECT_EQ(error.id, "compile.glsl");
  EXPECT_EQ(error.file, "techniques/relief/relief.glsl");
  EXPECT_EQ(error.line, 12);
  EXPECT_EQ(error.message, "'missing' : undeclared identifier (permutation 'sample/view=relief')");
}

TEST(CompileDiagnostics, SeveralErrorsAreListedAndTheFirstGivesThePlace) {
  const Error error = error_of(compute_program(R"(
#line 7 "a.glsl"
void first() { int a = alpha; }
#line 20 "b.glsl"
void second() { int b = beta; }
void main() {}
)"));
  EXPECT_EQ(error.file, "a.glsl");
  EXPECT_EQ(error.line, 7);
  EXPECT_NE(error.message.find("a.glsl:7: 'alpha' : undeclared identifier"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("b.glsl:20: 'beta' : undeclared identifier"), std::string::npos) << error.message;
}

TEST(CompileDiagnostics, AtMostTenErrorsAreListed) {
  std::string log;
  for (int i = 1; i <= 25; ++i) log += "ERROR: a.glsl:" + std::to_string(i) + ": 'x' : undeclared identifier \n";
  const Error error = glsl_error(log, "key");
  EXPECT_EQ(std::count(error.message.begin(), error.message.end(), '\n'), 10);
  EXPECT_NE(error.message.find("25 errors"), std::string::npos);
}

TEST(CompileDiagnostics, PathsMayHoldColonsAndSpaces) {
  const auto found = parse_glslang_log("ERROR: C:/my shaders/a:b.glsl:12: 'x' : undeclared identifier \n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].file, "C:/my shaders/a:b.glsl");
  EXPECT_EQ(found[0].line, 12);
  EXPECT_EQ(found[0].message, "'x' : undeclared identifier");
}

TEST(CompileDiagnostics, SummariesAndWarningsAreLeftOut) {
  const auto found = parse_glslang_log(
      "WARNING: a.glsl:1: something\nERROR: a.glsl:2: '' :  syntax error\nERROR: a.glsl:2: '' : compilation "
      "terminated \nERROR: 2 compilation errors.  No code generated.\n\n\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].message, "syntax error");
}

TEST(CompileDiagnostics, ALinkErrorKeepsItsContinuation) {
  const Error error = error_of(compute_program("float unseen(float x);\nvoid main() { unseen(1.0); }"));
  EXPECT_EQ(error.id, "compile.glsl");
  EXPECT_NE(error.message.find("No function definition (body) found: unseen("), std::string::npos) << error.message;
}

TEST(CompileDiagnostics, AnEmptyLogStillNamesThePermutation) {
  EXPECT_NE(glsl_error("", "key").message.find("'key'"), std::string::npos);
}

TEST(CompileDiagnostics, TextsThatAreNotGlslAreErrorsNotCrashes) {
  for (const std::string text : {"}", "((((((", "#if", "void main() {", "\x80\xff\x01", "#version 9999\nvoid main(){}",
                                 "#extension GL_none : require\nvoid main(){}", "/*"}) {
    EXPECT_EQ(error_of(testing::make_program({{ShaderStage::fragment, text, {}}})).id, "compile.glsl") << text;
  }
}

std::string chain(const std::string& first, const std::string& link, int length) {
  std::string text = first;
  for (int i = 0; i < length; ++i) text += link;
  return text;
}

TEST(CompileDiagnostics, ARunawayExpressionIsAnErrorNotAStackOverflow) {
  for (const std::string& expression : {chain("a", "+a", 100000), chain("a", "+f(a,a)", 100000),
                                        chain("(a", ",a", 100000) + ")", chain("vec4(a)", ".xyzw", 100000) + ".x"}) {
    const Error error = error_of(compute_program(
        "float f(float x, float y) { return x; }\nvoid main() { float a = 1.0; a = " + expression + "; }"));
    EXPECT_EQ(error.id, "compile.glsl");
    EXPECT_NE(error.message.find("chains more than 4000 operators"), std::string::npos) << error.message.substr(0, 200);
  }
}

TEST(CompileDiagnostics, LongTablesCommentsAndCodeAreNotRunaway) {
  EXPECT_FALSE(has_runaway_expression(chain("const float t[] = float[](0.0", ", -0.5 + 0.25", 20000) + ");"));
  EXPECT_FALSE(has_runaway_expression(chain("// ", "-", 20000) + "\nvoid main() {}"));
  EXPECT_FALSE(has_runaway_expression(chain("/* ", "=", 20000) + "*/ void main() {}"));
  EXPECT_FALSE(has_runaway_expression(chain("void main() {", "a = a + b * c.x;\n", 20000) + "}"));
}

}  // namespace
}  // namespace relievo
