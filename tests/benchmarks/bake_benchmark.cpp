/// Baking cones against looking at every pair of cells. The argument is the map's width in texels. `pairs`
/// extrapolates: it looks from every 16th row's cells and reports the seconds that all rows would take on one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "relievo/describe.hpp"
#include "relievo/maps.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

Result<MapSet> baked(const std::string& name, MapSet maps) {
  static const Result<Registry> registry = load_registry();
  static const Result<std::unique_ptr<Backend>> backend = open_backend("vulkan");
  if (!registry) return tl::unexpected(registry.error());
  if (!backend) return tl::unexpected(backend.error());
  if (Status status = bake_map(**backend, *registry, name, maps); !status) return tl::unexpected(status.error());
  return maps;
}

void bake(benchmark::State& state, const std::string& name) {
  const int width = static_cast<int>(state.range(0));
  const Result<MapSet> input = baked("max_pyramid", map_set(test::smooth_noise_map(width, width)));
  if (!input) return state.SkipWithError(input.error().message.c_str());
  for (auto _ : state) {
    if (const Result<MapSet> result = baked(name, *input); !result)
      return state.SkipWithError(result.error().message.c_str());
  }
  state.counters["ns_per_texel"] =
      benchmark::Counter(static_cast<double>(width) * width * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(bake, robust_cone, std::string("robust_cone"))
    ->RangeMultiplier(2)
    ->Range(256, 2048)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(bake, directional_cone, std::string("directional_cone"))
    ->RangeMultiplier(2)
    ->Range(256, 1024)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The steepest slope from one cell to any other of a map that repeats, each at its nearest copy.
float steepest(const std::vector<float>& highest, int width, int x, int y, float apex) {
  float slope = 0;
  for (int j = 0; j < width; ++j) {
    const int rows = std::min(std::abs(j - y), width - std::abs(j - y)) - 1;
    for (int i = 0; i < width; ++i) {
      const int distance = std::max(std::min(std::abs(i - x), width - std::abs(i - x)) - 1, rows);
      const float rise =
          highest[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)] - apex;
      slope = std::max(slope, rise / static_cast<float>(std::max(distance, 1)));
    }
  }
  return slope;
}

void pairs(benchmark::State& state) {
  constexpr int stride = 16;
  const int width = static_cast<int>(state.range(0));
  const std::vector<float> highest = test::smooth_noise_map(width, width).texels;
  for (auto _ : state) {
    for (int y = 0; y < width; y += stride) {
      for (int x = 0; x < width; ++x) benchmark::DoNotOptimize(steepest(highest, width, x, y, 0.5f));
    }
  }
  state.counters["all_rows_s"] =
      benchmark::Counter(1.0 / stride, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(pairs)->Arg(256)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relievo
