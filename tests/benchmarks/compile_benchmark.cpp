/// The compile stage on a vertex and a fragment shader. Measured warm: the first call in a process builds glslang's
/// symbol tables.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

/// `text` with every capital N written as a number.
std::string with_number(const std::string& text, int number) {
  std::string result;
  for (const char c : text) result += c == 'N' ? std::to_string(number) : std::string(1, c);
  return result;
}

/// Several marching functions of the kind that techniques are made of, two loops each. Four make a program like most
/// permutations, sixteen make about 300 lines without a comment.
ComposedProgram marching_program(int functions) {
  std::string text = R"(
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(constant_id = 0) const int steps = 16;
layout(set = 0, binding = 1, std140) uniform March {
  float scale;
  float bias;
  vec4 direction;
} march;
layout(set = 1, binding = 0) uniform sampler2D relievo_height_map;
layout(set = 1, binding = 1) uniform sampler2D relievo_cone_map;
float height(vec2 place) {
  return textureLod(relievo_height_map, place, 0.0).x * march.scale + march.bias;
}
)";
  for (int i = 0; i < functions; ++i) {
    const std::string function = R"(
vec3 march_N(vec3 origin, vec3 direction) {
  vec3 before = origin;
  vec3 place = origin;
  for (int i = 0; i < steps; ++i) {
    float h = height(place.xy + float(N) * 0.01);
    if (place.z <= h) break;
    float cone = textureLod(relievo_cone_map, place.xy, 0.0).x;
    before = place;
    place += direction * cone * (place.z - h);
  }
  for (int i = 0; i < 5; ++i) {
    vec3 middle = (before + place) * 0.5;
    if (middle.z > height(middle.xy)) before = middle; else place = middle;
  }
  return place;
}
)";
    text += with_number(function, i);
  }
  text += "void main() {\n  vec3 sum = vec3(uv, 1.0);\n";
  for (int i = 0; i < functions; ++i) {
    text += fmt::format("  sum = march_{}(sum, march.direction.xyz);\n", i);
  }
  text += "  color = vec4(sum, 1.0);\n}\n";
  return testing::fragment_program(text);
}

void run(benchmark::State& state, std::span<const Target> targets, const CompileOptions& options) {
  const ComposedProgram program = marching_program(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    auto compiled = compile(program, targets, options);
    if (!compiled) return state.SkipWithError(compiled.error().message.c_str());
    benchmark::DoNotOptimize(compiled);
  }
}

void compile_to_all_targets(benchmark::State& state) {
  run(state, all_targets(), {});
}
void compile_to_spirv(benchmark::State& state) {
  run(state, {}, {});
}
void compile_to_spirv_without_validation(benchmark::State& state) {
  run(state, {}, {true, false});
}
void compile_to_spirv_without_optimization(benchmark::State& state) {
  run(state, {}, {false, true});
}

BENCHMARK(compile_to_all_targets)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(compile_to_spirv)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(compile_to_spirv_without_validation)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(compile_to_spirv_without_optimization)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relievo
