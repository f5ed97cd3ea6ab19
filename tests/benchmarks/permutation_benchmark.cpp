/// One permutation from its descriptor to every output, warm and in process: the design's aim is at most 15 ms.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "relievo/compile.hpp"

namespace relievo {
namespace {

const Registry& registry() {
  static const Registry loaded = *load_registry();
  return loaded;
}

Permutation relief_in(const char* stage) {
  Permutation permutation;
  permutation.stage = stage;
  permutation.roles["view"] = "relief";
  return permutation;
}

std::vector<Target> allowed_targets(const ComposedProgram& composed) {
  std::vector<Target> targets;
  for (const Target& target : all_targets()) {
    if (check_capabilities(target, composed, {})) targets.push_back(target);
  }
  return targets;
}

/// Processes that this one has waited for: none may be forked for a shader.
long child_page_faults() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_minflt;
}

/// The benchmark's argument is the number of threads.
void to_every_target(benchmark::State& state, const char* stage) {
  const std::vector<Target> targets = allowed_targets(*compose(registry(), relief_in(stage)));
  CompileOptions options;
  options.threads = static_cast<unsigned>(state.range(0));
  for (auto _ : state) {
    const auto composed = compose(registry(), relief_in(stage));
    const auto compiled = compile(*composed, targets, options);
    if (!compiled) return state.SkipWithError(compiled.error().message.c_str());
    benchmark::DoNotOptimize(compiled->shaders.data());
  }
  if (child_page_faults() != 0) state.SkipWithError("a process was forked");
  state.counters["targets"] = static_cast<double>(targets.size());
}

/// Cold where it is the first to compile in its process, so it is registered first and runs once.
void ColdSurface(benchmark::State& state) {
  to_every_target(state, "surface");
}
void SurfaceToEveryTarget(benchmark::State& state) {
  to_every_target(state, "surface");
}
void RayToEveryTarget(benchmark::State& state) {
  to_every_target(state, "ray");
}
void PrismToEveryTarget(benchmark::State& state) {
  to_every_target(state, "prism");
}

void ComposeSurface(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(compose(registry(), relief_in("surface"))->shaders.data());
}

void warm(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->MinWarmUpTime(0.2);
}

BENCHMARK(ColdSurface)->Unit(benchmark::kMillisecond)->ArgName("threads")->Arg(1)->UseRealTime()->Iterations(1);
BENCHMARK(SurfaceToEveryTarget)->Apply(warm);
BENCHMARK(RayToEveryTarget)->Apply(warm);
BENCHMARK(PrismToEveryTarget)->Apply(warm);
BENCHMARK(ComposeSurface)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relievo
