#include "report/sweep.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>

#include "evaluation/at_once.hpp"
#include "report/sweep_run.hpp"

namespace relievo::cli {

namespace {

constexpr double heat_angle = 20;  // degrees, where techniques differ most to the eye

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::span<MapSweep> timed_maps(std::span<MapSweep> maps, const SweepPlan& plan) {
  return plan.times_all ? maps : maps.first(std::min<std::size_t>(maps.size(), 1));
}

/// Bakes `name` and first what it is baked from, each timed apart.
Status bake_timed(Backend& backend, MapRun& run, const std::string& name, std::vector<MapCost>& costs) {
  if (run.maps.contains(name)) return {};
  Result<const MapDescriptor*> map = run.input.registry->map(name);
  if (!map) return tl::unexpected(map.error());
  for (const std::string& needed : (*map)->inputs) {
    if (Status status = bake_timed(backend, run, needed, costs); !status) return status;
  }
  auto start = std::chrono::steady_clock::now();
  if (Status status = bake_map(backend, *run.input.registry, name, run.maps, run.values); !status) return status;
  const HeightMap& height = run.ray_case.height;
  costs.push_back({run.ray_case.name, name, height.width, height.height, texture_bytes(run.maps.find(name)->second),
                   seconds_since(start)});
  return {};
}

Status bake_all(Backend& backend, MapRun& run, std::vector<MapCost>& costs) {
  const HeightMap& height = run.ray_case.height;
  costs.push_back(
      {run.ray_case.name, "height", height.width, height.height, texture_bytes(run.maps.find("height")->second), -1});
  for (const std::string& technique : run.input.techniques) {
    for (const std::string& map : run.input.registry->techniques.find(technique)->second.maps) {
      if (Status status = bake_timed(backend, run, map, costs); !status) return status;
    }
  }
  return {};
}

/// Whatever need not be timed.
Status prepare(Backend& backend, const Sweep& sweep, std::span<MapSweep> maps, Progress& progress) {
  std::vector<BackendWork> pieces;
  for (MapSweep& map : maps) {
    pieces.emplace_back([&](Backend& one) {
      progress.advance(fmt::format("counting {} on {}", map.run.ray_case.name, one.info().name));
      return count_map(one, sweep, map);
    });
  }
  for (const MapSweep& map : timed_maps(maps, sweep.plan)) {
    const std::span<const TraceRequest> requests = map.timed.requests;
    for (std::size_t part = 0; part < backends_at_once; ++part) {
      const std::size_t first = requests.size() * part / backends_at_once;
      const std::size_t last = requests.size() * (part + 1) / backends_at_once;
      if (first == last) continue;
      const auto some = requests.subspan(first, last - first);
      pieces.emplace_back([&map, some](Backend& one) { return compile_ahead(map.run, one, some); });
    }
  }
  return share_work(backend, pieces);
}

std::vector<SweepRow> empty_rows(const MapRun& run, Angles angles, const std::string& backend) {
  std::vector<SweepRow> rows;
  for (double angle : angles)
    for (const Setting& setting : run.settings) rows.push_back({run.ray_case.name, backend, angle, setting, {}});
  return rows;
}

/// Counts, then times some maps on a backend.
Status sweep_maps(std::span<const MapRun> runs, Backend& backend, Sweep& sweep, Progress& progress) {
  const std::string& name = sweep.backends.back();
  std::vector<MapSweep> maps;
  for (const MapRun& run : runs) maps.push_back({run, empty_rows(run, run.plan.angles, name)});
  const std::span<MapSweep> timed = timed_maps(maps, sweep.plan);
  for (MapSweep& map : timed) map.timed = timed_requests(map.run, backend.info(), !sweep.reference.empty());
  if (Status status = prepare(backend, sweep, maps, progress); !status) return status;
  for (MapSweep& map : timed) {
    progress.advance(fmt::format("timing {} on {}", map.run.ray_case.name, name));
    if (Status status = time_rows(map.run, map.timed, map.run.plan.angles, backend, map.rows); !status) return status;
  }
  for (MapSweep& map : maps) {
    move_to(sweep.rows, map.rows);
    move_to(sweep.heat, map.heat);
  }
  return {};
}

/// Times the first map at the first angle on the first backend again.
Status time_again(const MapRun& run, Backend& backend, Sweep& sweep) {
  const Angles angle = Angles(run.plan.angles).first(1);
  const TimedRequests timed = timed_requests(run, backend.info(), !sweep.reference.empty());
  std::vector<SweepRow> rows = empty_rows(run, angle, backend.info().name);
  if (Status status = time_rows(run, timed, angle, backend, rows); !status) return status;
  std::vector<double> changes;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    double first = sweep.rows[r].ratio, second = rows[r].ratio;
    if (first > 0 && second > 0) changes.push_back(std::abs(second / first - 1));
  }
  if (changes.empty()) return {};
  std::sort(changes.begin(), changes.end());
  sweep.rerun = {changes.size(), changes[changes.size() / 2], changes[changes.size() * 9 / 10], changes.back()};
  return {};
}

MapRun make_run(const EvaluationInput& input, const SweepPlan& plan, const RayCase& ray_case,
                const std::vector<Setting>& settings) {
  std::map<std::string, double> values = input.values;
  set_scale(*input.registry, ray_case.scale, ray_case.height, values);
  MapSet& maps = input.baked->of(*input.registry, ray_case.height, "sweep", values);
  MapRun run{input, plan, ray_case, settings, std::move(values), rays_of(ray_case, plan.angles, plan.image), {}, maps};
  Oracle oracle(ray_case.height);
  for (const std::vector<Ray>& rays : run.rays) run.truth.push_back(oracle.trace(rays));
  return run;
}

/// Every backend over the maps; the maps that techniques read are baked once, by the first backend.
Status sweep_backends(const EvaluationInput& input, const std::vector<Setting>& settings, Sweep& sweep) {
  const std::size_t elsewhere = std::min(sweep.plan.maps_elsewhere, sweep.maps.size());
  Progress progress("sweep", 2 * sweep.maps.size() + (sweep.plan.times_all ? sweep.maps.size() : 1) + 1 +
                                 2 * elsewhere * (input.backends.size() - 1));
  std::vector<MapRun> runs;
  for (const RayCase& ray_case : input.ray_cases) runs.push_back(make_run(input, sweep.plan, ray_case, settings));
  input.clock->end("oracle's rays");
  for (const std::string& name : input.backends) {
    if (elsewhere == 0 && !sweep.backends.empty()) break;
    Result<std::unique_ptr<Backend>> backend = open(name, false);
    if (!backend && backend.error().code == ErrorCode::unsupported) {
      sweep.not_run.push_back({"sweep on " + name, backend.error().message});
      continue;
    }
    if (!backend) return tl::unexpected(backend.error());
    sweep.backends.push_back(name);
    const bool first_backend = sweep.backends.size() == 1;
    for (std::size_t i = 0; first_backend && i < runs.size(); ++i) {
      progress.advance(fmt::format("baking for {} on {}", runs[i].ray_case.name, name));
      if (Status status = bake_all(**backend, runs[i], sweep.costs); !status) return status;
    }
    if (first_backend) input.clock->end("baking");
    const std::span<const MapRun> swept = std::span(runs).first(first_backend ? runs.size() : elsewhere);
    if (Status status = sweep_maps(swept, **backend, sweep, progress); !status) return status;
    input.clock->end("sweep");
    if (!first_backend) continue;
    progress.advance("rerun on " + name);
    if (Status status = time_again(runs.front(), **backend, sweep); !status) return status;
    input.clock->end("sweep, again");
  }
  return {};
}

}  // namespace

Result<Sweep> run_sweep(const EvaluationInput& input, const SweepPlan& plan) {
  auto start = std::chrono::steady_clock::now();
  Sweep sweep;
  sweep.plan = plan;
  if (input.ray_cases.empty()) return sweep;
  for (const RayCase& ray_case : input.ray_cases) sweep.maps.push_back(ray_case.name);
  if (input.registry->techniques.contains(reference_technique)) sweep.reference = reference_technique;
  sweep.heat_angle = *std::min_element(plan.angles.begin(), plan.angles.end(), [](double a, double b) {
    return std::abs(a - heat_angle) < std::abs(b - heat_angle);
  });
  Result<std::vector<Setting>> settings = make_settings(input, plan);
  if (!settings) return tl::unexpected(settings.error());
  for (const std::string& name : input.techniques) {
    for (const Parameter& p : input.registry->techniques.find(name)->second.parameters) {
      auto given = input.values.find(name + "." + p.name);
      if (p.is_loop) sweep.defaults[name + "." + p.name] = given == input.values.end() ? p.value : given->second;
    }
  }
  if (Status status = sweep_backends(input, *settings, sweep); !status) return tl::unexpected(status.error());
  mark_best(sweep.rows);
  sweep.seconds = seconds_since(start);
  return sweep;
}

}  // namespace relievo::cli
