/// Speed of the oracle in rays per second. The argument is the angle above the base plane in degrees, on a map of
/// 1024² texels whose height is a tenth of its width.
#include <benchmark/benchmark.h>

#include <numbers>

#include "oracle/walk.hpp"
#include "relievo/oracle.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

constexpr double scale = 0.1;
constexpr int ray_count = 1 << 16;

std::vector<Ray> rays_at(double degrees) {
  test::Random random(7);
  const double slope = std::tan(degrees * std::numbers::pi / 180) / scale;
  std::vector<Ray> rays(ray_count);
  for (Ray& ray : rays) {
    const double heading = random.uniform(0, 2 * std::numbers::pi);
    ray = {random.uniform(), random.uniform(), 1, std::cos(heading), std::sin(heading), -slope};
  }
  return rays;
}

const HeightMap& hills() {
  static const HeightMap map = test::smooth_noise_map(1024, 1024);
  return map;
}

void report(benchmark::State& state, std::uint64_t steps) {
  const auto rays = static_cast<double>(state.iterations()) * ray_count;
  state.counters["rays"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  state.counters["cells"] = static_cast<double>(steps) / ray_count;
}

std::uint64_t total_steps(const std::vector<Hit>& hits) {
  std::uint64_t steps = 0;
  for (const Hit& hit : hits) steps += hit.steps;
  return steps;
}

void trace_all_threads(benchmark::State& state) {
  const Oracle oracle(hills());
  const std::vector<Ray> rays = rays_at(static_cast<double>(state.range(0)));
  std::vector<Hit> hits;
  for (auto _ : state) hits = oracle.trace(rays);
  report(state, total_steps(hits));
}
BENCHMARK(trace_all_threads)->Arg(60)->Arg(20)->Arg(8)->UseRealTime()->Unit(benchmark::kMillisecond);

void trace_one_thread(benchmark::State& state, bool with_pyramid) {
  const oracle::Lattice lattice(hills());
  const oracle::MaxPyramid pyramid(lattice);
  const std::vector<Ray> rays = rays_at(static_cast<double>(state.range(0)));
  std::vector<Hit> hits(rays.size());
  for (auto _ : state)
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = oracle::find_first_hit(lattice, with_pyramid ? &pyramid : nullptr, {}, rays[i]);
  report(state, total_steps(hits));
}
BENCHMARK_CAPTURE(trace_one_thread, pyramid, true)->Arg(60)->Arg(20)->Arg(8)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_one_thread, every_cell, false)->Arg(60)->Arg(20)->Arg(8)->Unit(benchmark::kMillisecond);

void set_up(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Oracle(hills()));
}
BENCHMARK(set_up)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relievo
