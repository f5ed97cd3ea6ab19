/// What counting and timing share: one height map of a sweep.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "relievo/trace.hpp"
#include "report/sweep.hpp"

namespace relievo::cli {

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

/// What is timed at an angle in a round.
struct TimedRequests {
  std::vector<TraceRequest> requests;
  std::vector<std::size_t> settings, references;  ///< places of the settings that want a time, and of the reference
};

/// What one backend finds on a map.
struct MapSweep {
  const MapRun& run;
  std::vector<SweepRow> rows;  ///< rows[angle · settings + setting]
  TimedRequests timed = {};    ///< empty where no times are wanted
  std::vector<HeatMap> heat = {};
};

using Angles = std::span<const double>;

/// One set an angle, image² rays each.
std::vector<std::vector<Ray>> rays_of(const RayCase& ray_case, Angles angles, int image);

TraceRequest request_of(const MapRun& run, const BackendInfo& backend, const Setting& setting, bool count_cost);

/// One Job of all sets of rays with all requests.
Result<JobResult> trace_all(const MapRun& run, Backend& backend, std::span<const std::vector<Ray>> rays,
                            std::span<const TraceRequest> requests, TraceRounds rounds, bool count_cost);

/// Hits, steps and fetches of all settings, with some hits in memory at once.
Status count_map(Backend& backend, const Sweep& sweep, MapSweep& map);

/// What times are relative to: the technique that engines run, at its descriptor's counts, with the hardware filter.
inline constexpr const char* reference_technique = "relief";

/// With the reference several times among the settings of `run` that want a time, if there is one.
TimedRequests timed_requests(const MapRun& run, const BackendInfo& backend, bool has_reference);

/// One ray with some of the programs that are timed later, alone on the machine: drivers keep what they compile.
Status compile_ahead(const MapRun& run, Backend& backend, std::span<const TraceRequest> requests);

/// Of the rows that want times, which are those of all settings at `angles`. Without timestamps they keep none.
Status time_rows(const MapRun& run, const TimedRequests& timed, Angles angles, Backend& backend,
                 std::vector<SweepRow>& rows);

}  // namespace relievo::cli
