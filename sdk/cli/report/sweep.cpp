#include "report/sweep.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "evaluation/at_once.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

/// What times are relative to: the technique that engines run, at its descriptor's counts, with the hardware filter.
constexpr const char* reference_technique = "relief";
constexpr std::size_t references_a_round = 8;  // at most, among the settings at equal distances
constexpr double heat_angle = 20;              // degrees, where techniques differ most to the eye

/// Hits read back at once, by all workers, stay below this, or are those of one setting each.
constexpr std::size_t largest_read_back = std::size_t{256} << 20;
constexpr std::size_t bytes_a_hit = 32;

/// Threads that prepare what is timed, each with a backend and copies of a map's textures.
constexpr std::size_t workers = 2;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One height map with its rays; the same for every backend.
struct MapRun {
  const EvaluationInput& input;
  const SweepPlan& plan;
  const RayCase& ray_case;
  const std::vector<Setting>& settings;
  std::map<std::string, double> values;  ///< with the map's scale
  std::vector<std::vector<Ray>> rays;    ///< one set an angle
  std::vector<std::vector<Hit>> truth;
  MapSet& maps;
};

/// What one backend finds on a map.
struct MapSweep {
  const MapRun& run;
  std::vector<SweepRow> rows;  ///< rows[angle · settings + setting]
  std::vector<HeatMap> heat = {};
};

std::span<MapSweep> timed_maps(std::span<MapSweep> maps, const SweepPlan& plan) {
  return plan.times_all ? maps : maps.first(std::min<std::size_t>(maps.size(), 1));
}

using Angles = std::span<const double>;

/// One set an angle, image² rays each.
std::vector<std::vector<Ray>> rays_of(const RayCase& ray_case, Angles angles, int image) {
  std::vector<std::vector<Ray>> sets;
  for (double angle : angles) sets.push_back(make_view_rays(angle, ray_case.scale, image, image));
  return sets;
}

TraceRequest request_of(const MapRun& run, const BackendInfo& backend, const Setting& setting, bool count_cost) {
  TraceRequest request{setting.technique, setting.filter, count_cost,
                       values_on(*run.input.registry, backend, run.values)};
  if (!setting.loop.empty()) request.values[setting.technique + "." + setting.loop] = setting.count;
  return request;
}

bool wants_time(const SweepPlan& plan, const Setting& setting) {
  return plan.times_all || setting.loop.empty();
}

/// What is timed at an angle in a round.
struct TimedRequests {
  std::vector<TraceRequest> requests;
  std::vector<std::size_t> settings, references;  ///< places of the settings that want a time, and of the reference
};

/// The reference comes again and again among the settings: one of its times alone differs by a fifth from the next.
TimedRequests timed_requests(const MapRun& run, const BackendInfo& backend, bool has_reference) {
  TraceRequest reference{reference_technique, HeightFilter::hardware, false, {}};
  set_scale(*run.input.registry, run.ray_case.scale, run.ray_case.height, reference.values);
  reference.values = values_on(*run.input.registry, backend, std::move(reference.values));
  const auto wanted = static_cast<std::size_t>(std::count_if(
      run.settings.begin(), run.settings.end(), [&](const Setting& one) { return wants_time(run.plan, one); }));
  const std::size_t between = (wanted + references_a_round - 1) / references_a_round;
  TimedRequests timed;
  for (const Setting& setting : run.settings) {
    if (!wants_time(run.plan, setting)) continue;
    if (has_reference && timed.settings.size() % between == 0) {
      timed.references.push_back(timed.requests.size());
      timed.requests.push_back(reference);
    }
    timed.settings.push_back(timed.requests.size());
    timed.requests.push_back(request_of(run, backend, setting, false));
  }
  return timed;
}

Result<JobResult> trace_all(const MapRun& run, Backend& backend, std::span<const std::vector<Ray>> rays,
                            std::span<const TraceRequest> requests, TraceRounds rounds, bool count_cost) {
  Result<Job> job =
      make_trace_job(*run.input.registry, run.maps, rays, requests, backend.info().shader_target, rounds, count_cost);
  if (!job) return tl::unexpected(job.error());
  return backend.execute(*job);
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

HeatMap heat_map(const MapRun& run, const Setting& setting, const std::vector<Hit>& truth,
                 const std::vector<Hit>& hits) {
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN(), wrong = std::numeric_limits<float>::infinity();
  const HeightMap& height = run.ray_case.height;
  HeatMap heat{setting.technique, run.plan.image, {}, {}};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ErrorFigures one = compare_hits({&truth[i], 1}, {&hits[i], 1}, height.width, height.height);
    bool right = one.missed + one.false_hit + one.wrong_layer + one.exhausted == 0;
    heat.steps.push_back(one.judged ? static_cast<float>(hits[i].steps) : nothing);
    const float texels = std::isnan(one.uv_texels.max) ? 0 : static_cast<float>(one.uv_texels.max);  // rightly no hit
    heat.texels.push_back(!one.judged ? nothing : right ? texels : wrong);
  }
  return heat;
}

bool shown_as_heat(const MapRun& run, const Setting& setting, const Sweep& sweep, double angle) {
  return run.ray_case.name == sweep.maps.front() && angle == sweep.heat_angle && setting.loop.empty() &&
         setting.filter == HeightFilter::exact && sweep.backends.size() == 1;
}

/// Hits, steps and fetches of the settings [first, last).
Status count_some(Backend& backend, std::size_t first, std::size_t last, const Sweep& sweep, MapSweep& map) {
  const MapRun& run = map.run;
  std::vector<TraceRequest> requests;
  for (std::size_t k = first; k < last; ++k) requests.push_back(request_of(run, backend.info(), run.settings[k], true));
  Result<JobResult> result = trace_all(run, backend, run.rays, requests, {}, true);
  if (!result) return tl::unexpected(result.error());
  const HeightMap& height = run.ray_case.height;
  for (std::size_t s = 0; s < run.rays.size(); ++s) {
    for (std::size_t k = first; k < last; ++k) {
      std::vector<std::byte>& bytes = result->read_backs[s * requests.size() + k - first];
      std::vector<Hit> hits = read_hits(bytes, run.rays[s]);
      bytes = {};
      SweepRow& row = map.rows[s * run.settings.size() + k];
      row.error = compare_hits(run.truth[s], hits, height.width, height.height);
      if (shown_as_heat(run, run.settings[k], sweep, row.angle))
        map.heat.push_back(heat_map(run, run.settings[k], run.truth[s], hits));
    }
  }
  return {};
}

Status count_map(Backend& backend, const Sweep& sweep, MapSweep& map) {
  const MapRun& run = map.run;
  const std::size_t a_setting = run.rays.size() * run.rays.front().size() * bytes_a_hit;
  const std::size_t at_once = std::max<std::size_t>(1, largest_read_back / workers / a_setting);
  for (std::size_t first = 0; first < run.settings.size(); first += at_once) {
    const std::size_t last = std::min(first + at_once, run.settings.size());
    if (Status status = count_some(backend, first, last, sweep, map); !status) return status;
  }
  return {};
}

/// One ray with some of the programs that are timed later, alone on the machine: drivers keep what they compile.
Status compile_ahead(const MapRun& run, Backend& backend, std::span<const TraceRequest> requests) {
  const std::vector<Ray> one_ray = {run.rays.front().front()};
  Result<JobResult> result = trace_all(run, backend, {&one_ray, 1}, requests, {}, false);
  if (!result) return tl::unexpected(result.error());
  return {};
}

using Work = std::function<Status(Backend&)>;

/// On the backend, and beside it on others of its kind, as far as they can be opened: drivers compile on one thread
/// each.
Status work_at_once(Backend& backend, std::span<const Work> pieces) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&](Backend& one) -> Status {
    for (std::size_t i = next++; i < pieces.size(); i = next++) {
      Status status = pieces[i](one);
      if (status) continue;
      next = pieces.size();
      return status;
    }
    return {};
  };
  std::vector<Backend*> backends(std::min(workers, pieces.size()));
  if (!backends.empty()) backends.front() = &backend;
  return for_each_at_once(backends, [&](Backend* one) -> Status {
    if (one) return work(*one);
    Result<std::unique_ptr<Backend>> other = open(backend.info().name, false);
    return other ? work(**other) : Status();
  });
}

/// Whatever need not be timed.
Status prepare(Backend& backend, const Sweep& sweep, std::span<MapSweep> maps, Progress& progress) {
  std::vector<Work> pieces;
  for (MapSweep& map : maps) {
    pieces.emplace_back([&](Backend& one) {
      progress.advance(fmt::format("counting {} on {}", map.run.ray_case.name, one.info().name));
      return count_map(one, sweep, map);
    });
  }
  for (const MapSweep& map : timed_maps(maps, sweep.plan)) {
    const auto requests = std::make_shared<const std::vector<TraceRequest>>(
        timed_requests(map.run, backend.info(), !sweep.reference.empty()).requests);
    for (std::size_t part = 0; part < workers; ++part) {
      const std::size_t first = requests->size() * part / workers, last = requests->size() * (part + 1) / workers;
      if (first == last) continue;
      pieces.emplace_back([&map, requests, first, last](Backend& one) {
        return compile_ahead(map.run, one, std::span(*requests).subspan(first, last - first));
      });
    }
  }
  return work_at_once(backend, pieces);
}

/// Medians of the reference's times in each round; none without a reference.
std::vector<double> reference_seconds(std::span<const std::vector<double>> seconds, const TimedRequests& timed) {
  std::vector<double> rounds;
  for (std::size_t k = 0; !timed.references.empty() && k < seconds[timed.references.front()].size(); ++k) {
    std::vector<double> times;
    for (std::size_t place : timed.references) times.push_back(seconds[place][k]);
    rounds.push_back(median(times));
  }
  return rounds;
}

void set_times(const std::vector<double>& times, std::span<const double> reference, SweepRow& row) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    if (reference[k] > 0) ratios.push_back(times[k] / reference[k]);
  }
  const auto [fastest, slowest] = std::minmax_element(times.begin(), times.end());
  row.seconds = median(times);
  row.spread = row.seconds > 0 && times.size() > 1 ? (*slowest - *fastest) / row.seconds : -1;
  row.ratio = median(ratios);
}

/// Of the rows that want them.
Status time_all(const MapRun& run, Angles angles, Backend& backend, bool has_reference, std::vector<SweepRow>& rows) {
  const TimedRequests timed = timed_requests(run, backend.info(), has_reference);
  const TraceRounds rounds{run.plan.repeats, true};
  const std::vector<std::vector<Ray>> rays = rays_of(run.ray_case, angles, run.plan.timed_image);
  Result<JobResult> result = trace_all(run, backend, rays, timed.requests, rounds, false);
  if (!result) return tl::unexpected(result.error());
  if (result->command_seconds.empty()) return {};  // no timestamps
  const std::vector<std::vector<double>> seconds = trace_seconds(*result, rays.size(), timed.requests.size(), rounds);
  auto row = rows.begin();
  for (std::size_t angle = 0; angle < angles.size(); ++angle) {
    const auto here = std::span(seconds).subspan(angle * timed.requests.size(), timed.requests.size());
    const std::vector<double> reference = reference_seconds(here, timed);
    auto place = timed.settings.begin();
    for (const Setting& setting : run.settings) {
      if (wants_time(run.plan, setting)) set_times(here[*place++], reference, *row);
      ++row;
    }
  }
  return {};
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
  if (Status status = prepare(backend, sweep, maps, progress); !status) return status;
  for (MapSweep& map : timed_maps(maps, sweep.plan)) {
    progress.advance(fmt::format("timing {} on {}", map.run.ray_case.name, name));
    Status status = time_all(map.run, map.run.plan.angles, backend, !sweep.reference.empty(), map.rows);
    if (!status) return status;
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
  std::vector<SweepRow> rows = empty_rows(run, angle, backend.info().name);
  if (Status status = time_all(run, angle, backend, !sweep.reference.empty(), rows); !status) return status;
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
