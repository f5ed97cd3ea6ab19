/// What a sweep counts: hits against the oracle's, steps and fetches.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "evaluation/at_once.hpp"
#include "report/sweep_run.hpp"

namespace relievo::cli {

namespace {

/// Hits read back at once, by all backends, stay below this, or are those of one setting each.
constexpr std::size_t largest_read_back = std::size_t{256} << 20;
constexpr std::size_t bytes_a_hit = 32;

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

}  // namespace

Status count_map(Backend& backend, const Sweep& sweep, MapSweep& map) {
  const MapRun& run = map.run;
  const std::size_t a_setting = run.rays.size() * run.rays.front().size() * bytes_a_hit;
  const std::size_t at_once = std::max<std::size_t>(1, largest_read_back / backends_at_once / a_setting);
  for (std::size_t first = 0; first < run.settings.size(); first += at_once) {
    const std::size_t last = std::min(first + at_once, run.settings.size());
    if (Status status = count_some(backend, first, last, sweep, map); !status) return status;
  }
  return {};
}

}  // namespace relievo::cli
