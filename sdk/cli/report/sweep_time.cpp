/// What a sweep times: settings in rounds, with the reference among them.
#include <algorithm>

#include "report/sweep_run.hpp"

namespace relievo::cli {

namespace {

/// At most, among the settings at equal distances: one time of the reference alone differs by a fifth from the next.
constexpr std::size_t references_a_round = 8;

bool wants_time(const SweepPlan& plan, const Setting& setting) {
  return plan.times_all || setting.loop.empty();
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

}  // namespace

TimedRequests timed_requests(const MapRun& run, const BackendInfo& backend, bool has_reference) {
  TraceRequest reference{reference_technique, HeightFilter::hardware, false, {}};
  set_scale(*run.input.registry, run.ray_case.scale, run.ray_case.height, reference.values);
  reference.values = values_on(*run.input.registry, backend, std::move(reference.values));
  const auto wanted = static_cast<std::size_t>(std::count_if(
      run.settings.begin(), run.settings.end(), [&](const Setting& one) { return wants_time(run.plan, one); }));
  const std::size_t references = has_reference ? std::min(references_a_round, wanted) : 0;
  TimedRequests timed;
  for (const Setting& setting : run.settings) {
    if (!wants_time(run.plan, setting)) continue;
    if (timed.references.size() * wanted <= timed.settings.size() * references &&
        timed.references.size() < references) {
      timed.references.push_back(timed.requests.size());
      timed.requests.push_back(reference);
    }
    timed.settings.push_back(timed.requests.size());
    timed.requests.push_back(request_of(run, backend, setting, false));
  }
  return timed;
}

Status compile_ahead(const MapRun& run, Backend& backend, std::span<const TraceRequest> requests) {
  const std::vector<Ray> one_ray = {run.rays.front().front()};
  Result<JobResult> result = trace_all(run, backend, {&one_ray, 1}, requests, {}, false);
  if (!result) return tl::unexpected(result.error());
  return {};
}

Status time_rows(const MapRun& run, const TimedRequests& timed, Angles angles, Backend& backend,
                 std::vector<SweepRow>& rows) {
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

}  // namespace relievo::cli
