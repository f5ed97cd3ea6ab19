/// Baking maps, and cones against looking at every pair of cells. The argument is the map's width in texels. `pairs`
/// extrapolates: it looks from every 16th row's cells and reports the seconds that all rows would take on one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "bake_memory.hpp"
#include "relievo/describe.hpp"
#include "relievo/maps.hpp"
#include "relievo/program_cache.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

/// An engine keeps its programs: shaders are compiled once, though drivers make their own code of them for every Job.
void keep_programs() {
  static const bool kept = [] {
    CacheOptions options;
    options.folder = std::filesystem::temp_directory_path() / "relievo_benchmarks";
    Result<std::unique_ptr<Cache>> cache = open_cache(options);
    if (cache) use_program_cache(std::move(*cache));
    return cache.has_value();
  }();
  benchmark::DoNotOptimize(kept);
}

Result<Backend*> vulkan() {
  static const Result<std::unique_ptr<Backend>> backend = open_backend("vulkan");
  if (!backend) return tl::unexpected(backend.error());
  return backend->get();
}

Status bake_into(Backend& backend, const std::string& name, MapSet& maps) {
  static const Result<Registry> registry = load_registry();
  if (!registry) return tl::unexpected(registry.error());
  return bake_map(backend, *registry, name, maps);
}

/// The maps that a map is baked from are there already.
void bake(benchmark::State& state, const std::string& name) {
  keep_programs();
  const int width = static_cast<int>(state.range(0));
  const Result<Backend*> backend = vulkan();
  if (!backend) return state.SkipWithError(backend.error().message.c_str());
  cli::MeteredBackend metered(**backend);
  MapSet maps = map_set(test::smooth_noise_map(width, width));
  Status status = bake_into(**backend, name, maps);
  for (auto _ : state) {
    if (!status) return state.SkipWithError(status.error().message.c_str());
    maps.erase(name);
    status = bake_into(metered, name, maps);
  }
  const double texels = static_cast<double>(width) * width;
  state.counters["ns_per_texel"] =
      benchmark::Counter(texels * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["commands_ms"] =
      benchmark::Counter(metered.command_seconds() * 1e3, benchmark::Counter::kAvgIterations);
  state.counters["height_maps"] = static_cast<double>(metered.peak_bytes()) / (texels * sizeof(float));
}

void to_2048(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(2)->Range(256, 2048)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(bake, max_pyramid, std::string("max_pyramid"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, quadrant_maxima, std::string("quadrant_maxima"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, robust_cone, std::string("robust_cone"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, directional_cone, std::string("directional_cone"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, cone, std::string("cone"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, rise_pyramid, std::string("rise_pyramid"))->Apply(to_2048);
BENCHMARK_CAPTURE(bake, relaxed_cone, std::string("relaxed_cone"))->Apply(to_2048);

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
