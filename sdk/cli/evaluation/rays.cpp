/// The `ray` stage: every technique against the oracle, and the backends against each other.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "evaluation/evaluation.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

std::vector<TraceRequest> requests(const EvaluationInput& input, HeightFilter filter, double scale, bool count) {
  std::vector<TraceRequest> list;
  for (const std::string& technique : input.techniques) {
    TraceRequest request{technique, filter, count, input.values};
    request.values.try_emplace("ray.scale", scale);
    list.push_back(std::move(request));
  }
  return list;
}

RayAgreement agree(const std::vector<Hit>& truth, const std::vector<Hit>& a, const std::vector<Hit>& b) {
  constexpr double relative = 1e-5;
  RayAgreement agreement;
  std::uint64_t equal = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].ambiguous) continue;
    ++agreement.judged;
    double size = std::max(std::abs(a[i].t), std::abs(b[i].t));
    equal += a[i].status == b[i].status && std::abs(a[i].t - b[i].t) <= relative * size;
  }
  agreement.equal_percent =
      agreement.judged ? 100.0 * static_cast<double>(equal) / static_cast<double>(agreement.judged) : 100.0;
  return agreement;
}

/// One case at one angle with one filter, on all backends.
struct RayRun {
  const EvaluationInput& input;
  const RayCase& ray_case;
  double angle;
  HeightFilter filter;
  const std::vector<Ray>& rays;
  const std::vector<Hit>& truth;
};

Status run_backend(const RayRun& run, Backend& backend, Evaluation& evaluation, std::vector<TraceResult>& counted) {
  MapSet& maps = run.input.baked->of(run.ray_case.height, backend.info().name);
  auto with_cost = requests(run.input, run.filter, run.ray_case.scale, true);
  Result<std::vector<TraceResult>> result =
      trace(backend, *run.input.registry, maps, run.rays, with_cost, 1, &evaluation.messages);
  if (!result) return tl::unexpected(result.error());
  counted = std::move(*result);
  std::vector<TraceResult> timed;
  if (run.input.time) {
    auto bare = requests(run.input, run.filter, run.ray_case.scale, false);
    Result<std::vector<TraceResult>> second =
        trace(backend, *run.input.registry, maps, run.rays, bare, run.input.repeats, &evaluation.messages);
    if (!second) return tl::unexpected(second.error());
    timed = std::move(*second);
  }
  for (std::size_t k = 0; k < counted.size(); ++k) {
    RayRow row{run.ray_case.name,
               run.input.techniques[k],
               backend.info().name,
               std::string(to_string(run.filter)),
               run.angle,
               {},
               -1};
    row.error = compare_hits(run.truth, counted[k].hits, run.ray_case.height.width, run.ray_case.height.height);
    if (!timed.empty()) row.seconds = median(timed[k].seconds);
    evaluation.rays.push_back(std::move(row));
  }
  return {};
}

Status run_case(const RayRun& run, OpenBackends& backends, Evaluation& evaluation, Progress& progress) {
  std::vector<std::vector<TraceResult>> results;
  for (auto& [name, backend] : backends) {
    progress.advance(fmt::format("rays {} {}° {} {}", run.ray_case.name, run.angle, to_string(run.filter), name));
    std::vector<TraceResult> counted;
    if (Status status = run_backend(run, *backend, evaluation, counted); !status) return status;
    results.push_back(std::move(counted));
  }
  if (run.filter != HeightFilter::exact || results.size() < 2) return {};
  for (std::size_t k = 0; k < run.input.techniques.size(); ++k) {
    RayAgreement agreement = agree(run.truth, results[0][k].hits, results[1][k].hits);
    agreement.case_name = run.ray_case.name;
    agreement.technique = run.input.techniques[k];
    agreement.angle = run.angle;
    evaluation.ray_agreements.push_back(agreement);
  }
  return {};
}

}  // namespace

Status evaluate_rays(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation, Progress& progress) {
  for (const RayCase& ray_case : input.ray_cases) {
    Oracle oracle(ray_case.height);
    for (double angle : ray_case.angles) {
      std::vector<Ray> rays = make_view_rays(angle, ray_case.scale, input.ray_image, input.ray_image);
      std::vector<Hit> truth = oracle.trace(rays);
      for (HeightFilter filter : {HeightFilter::exact, HeightFilter::hardware}) {
        if (Status status = run_case({input, ray_case, angle, filter, rays, truth}, backends, evaluation, progress);
            !status)
          return status;
      }
    }
  }
  return {};
}

}  // namespace relievo::cli
