// A function may change its `in` parameters; the caller's variable keeps its value. The compiler passes values where no
// statement does (compile/constant_parameters.hpp), which no result may show.
#include <gtest/gtest.h>

#include <cstring>

#include "job/program.hpp"
#include "support/pipeline.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

struct Case {
  const char* name;
  const char* functions;  ///< define `float f(float x)`-like things
  const char* call;       ///< of x = 3, y = 5 and i = 1, which no compiler can know
  float expected;
};

const Case cases[] = {
    {"Read", "float f(float x, vec2 y) { return x * y.x + y.y; }", "f(x, vec2(y, x))", 18},
    {"Assigned", "float f(float x) { x = x + 1.0; return x; }", "f(x) + 10.0 * x", 34},
    {"Counted", "float f(int i) { i++; return float(i); }", "f(i) + 10.0 * float(i)", 12},
    {"Swizzled", "float f(vec3 v) { v.zy += vec2(1.0, 2.0); return v.x + v.y + v.z; }", "f(vec3(x, y, 1.0))", 12},
    {"Member", "struct P { float a; vec2 b; }; float f(P p) { p.b.x *= 2.0; return p.a + p.b.x + p.b.y; }",
     "f(P(x, vec2(y, 1.0)))", 14},
    {"MemberRead", "struct P { float a; vec2 b; }; float f(P p) { return p.a + p.b[1]; }", "f(P(x, vec2(1.0, y)))", 8},
    {"PassedOnToInout", "void add(inout float v) { v += 1.0; } float f(float x) { add(x); return x; }",
     "f(x) + 10.0 * x", 34},
    {"PassedOnToOut", "void set(out float v) { v = 7.0; } float f(float x) { set(x); return x; }", "f(x) + 10.0 * x",
     37},
    {"OutOfABuiltIn", "float f(float x, float whole) { return modf(x + 0.5, whole) + whole; }", "f(x, y) + 10.0 * y",
     53.5},
    {"MemberOutOfABuiltIn", "float f(float x, vec2 v) { return modf(x + 0.5, v.y) + v.x * v.y; }", "f(x, vec2(y, y))",
     15.5},
    {"Looped", "float f(float x) { for (; x < 10.0; x *= 2.0) {} return x; }", "f(x) + 100.0 * x", 312},
    {"OnOnePath", "float f(float x, bool change) { if (change) x = 1.0; return x; }", "f(x, y > 9.0) + f(x, y > 2.0)",
     4},
    {"Component", "float f(vec3 v, int i) { return v[i]; }", "f(vec3(x, y, 7.0), i) + f(vec3(x, y, 7.0), i + 1)", 12},
    {"Column", "float f(mat2 m, int i) { return m[i].y; }", "f(mat2(1.0, x, 2.0, y), i)", 5},
    {"Element", "float f(float v[3], int i) { return v[i + 1]; }", "f(float[3](1.0, y, x), i)", 3},
    {"Declared first",
     "float f(float x, float y); float g(float x) { return f(x, x); } float f(float x, float y) { y = 2.0; return x * "
     "y; }",
     "g(x) + 10.0 * f(y, x)", 106},
    {"Overloaded", "float f(float v) { v = 1.0; return v; } float f(int v) { return float(v); }", "f(x) + f(i + 6)", 8},
    {"SameVariableInAndOut",  // 3 + 3 + 3, and x = 1
     "void f(float a, inout float b, out float c) { c = a + b; b = 1.0; c += a; }"
     "float g(float x) { float c; f(x, x, c); return c * 10.0 + x; }",
     "g(x)", 91},
    {"SideEffectBetweenReads", "float total = 1.0; float f(float v) { total += 1.0; return v + total; }",
     "f(total) + 10.0 * f(total)", 53},
    {"Exact", "float f(float a, float b) { precise float r = a * b + a; return r; }", "f(x, f(x, y))", 57},
};

ComposedProgram program_of(const Case& test) {
  return testing::compute_program(
      std::string("layout(set = 2, binding = 0, std430) buffer Values { float values[]; };\n") + test.functions + "\n" +
      "void main() { float x = values[0], y = values[1]; int i = int(values[2]);\n"
      "values[gl_LocalInvocationID.x] = " +
      test.call + "; }\n");
}

float run(const std::string& backend, const Case& test) {
  Backend& opened = test::backend(backend);
  Result<PreparedProgram> prepared = prepare_composed(program_of(test), opened.info().shader_target);
  if (!prepared) throw std::runtime_error(format(prepared.error()));
  Job job;
  job.programs.push_back(prepared->program);
  std::vector<float> values(64);
  values[0] = 3, values[1] = 5, values[2] = 1;
  Dispatch dispatch;
  const int index =
      bind_buffer(2, 0, make_buffer("Values", values.data(), values.size() * sizeof(float)), job, dispatch.resources);
  job.commands.emplace_back(dispatch);
  job.read_backs.push_back({ReadBack::Source::buffer, index, 0});
  Result<JobResult> result = opened.execute(job);
  if (!result) throw std::runtime_error(format(result.error()));
  EXPECT_THAT(result->messages, ::testing::IsEmpty());
  std::memcpy(values.data(), result->read_backs.front().data(), values.size() * sizeof(float));
  return values[5];
}

class ParameterCopies : public ::testing::TestWithParam<std::string> {};

TEST_P(ParameterCopies, NoResultShowsThem) {
  for (const Case& test : cases) EXPECT_EQ(run(GetParam(), test), test.expected) << test.name;
}

INSTANTIATE_TEST_SUITE_P(Backends, ParameterCopies, ::testing::ValuesIn(test::both_backends),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace relievo
