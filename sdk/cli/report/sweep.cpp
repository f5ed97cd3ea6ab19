#include "report/sweep.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

/// The sweep's images are small and its times noisy: it repeats at least this often.
constexpr int least_repeats = 5;

/// The loop that bounds the search is the longest one: relief's linear steps rather than its halvings.
const Parameter* search_loop(const TechniqueDescriptor& technique) {
  const Parameter* longest = nullptr;
  for (const Parameter& p : technique.parameters) {
    if (p.is_loop && (!longest || p.value > longest->value)) longest = &p;
  }
  return longest;
}

std::set<int> counts_of(const Parameter& loop) {
  std::set<int> counts = {static_cast<int>(loop.value)};
  for (int count : {8, 16, 32, 64, 128, 256, 400}) {
    if (count >= loop.minimum && count <= loop.maximum) counts.insert(count);
  }
  return counts;
}

/// The other loops keep their defaults, but none runs longer than the one that is varied.
void set_loops(const TechniqueDescriptor& technique, const Parameter& varied, int count,
               std::map<std::string, double>& values) {
  for (const Parameter& p : technique.parameters) {
    if (p.is_loop)
      values[technique.name + "." + p.name] =
          &p == &varied ? count : std::max(p.minimum, std::min<double>(p.value, count));
  }
}

/// Requests of one technique with what each is; the reference comes first.
struct Batch {
  std::vector<TraceRequest> requests;
  std::vector<SweepPoint> points;
};

Batch make_batch(const EvaluationInput& input, const TechniqueDescriptor& technique, double angle, double scale) {
  Batch batch;
  TraceRequest reference{"relief", HeightFilter::hardware, false, {}};
  reference.values = {{"ray.scale", scale}, {"relief.linear_steps", 100}, {"relief.binary_steps", 7}};
  batch.requests.push_back(reference);
  batch.points.push_back({});
  const Parameter* loop = search_loop(technique);
  for (HeightFilter filter : {HeightFilter::hardware, HeightFilter::exact}) {
    for (int count : loop ? counts_of(*loop) : std::set<int>{0}) {
      TraceRequest request{technique.name, filter, false, input.values};
      request.values.try_emplace("ray.scale", scale);
      if (loop) set_loops(technique, *loop, count, request.values);
      batch.requests.push_back(std::move(request));
      batch.points.push_back({technique.name, std::string(to_string(filter)), angle, loop ? loop->name : "", count});
    }
  }
  return batch;
}

/// What every batch at one angle shares.
struct Rays {
  std::vector<Ray> rays;
  std::vector<Hit> truth;
};

Status run_batch(const EvaluationInput& input, Backend& backend, MapSet& maps, const Rays& rays, Batch batch,
                 Sweep& sweep) {
  Result<std::vector<TraceResult>> results =
      trace(backend, *input.registry, maps, rays.rays, batch.requests, std::max(input.repeats, least_repeats));
  if (!results) return tl::unexpected(results.error());
  const HeightMap& height = input.ray_cases.front().height;
  double reference = median(results->front().seconds);
  for (std::size_t k = 1; k < batch.points.size(); ++k) {
    SweepPoint& point = batch.points[k];
    ErrorFigures error = compare_hits(rays.truth, (*results)[k].hits, height.width, height.height);
    point.wrong_percent = error.wrong_percent() + error.percent(error.exhausted);
    point.resolution = error.percent(1);
    point.seconds = median((*results)[k].seconds);
    if (reference > 0 && point.seconds > 0) point.ratio = point.seconds / reference;
    sweep.points.push_back(std::move(point));
  }
  return {};
}

}  // namespace

Result<Sweep> run_sweep(const EvaluationInput& input, const std::string& backend_name, int image) {
  Sweep sweep;
  if (input.ray_cases.empty()) return sweep;
  const RayCase& ray_case = input.ray_cases.front();
  sweep.case_name = ray_case.name;
  sweep.backend = backend_name;
  sweep.image = image;
  Result<std::unique_ptr<Backend>> backend = open(backend_name, false);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(ray_case.height);
  Oracle oracle(ray_case.height);
  Progress progress("sweep", sweep.angles.size() * input.techniques.size());
  for (double angle : sweep.angles) {
    Rays rays{make_view_rays(angle, ray_case.scale, image, image), {}};
    rays.truth = oracle.trace(rays.rays);
    for (const std::string& name : input.techniques) {
      progress.advance(fmt::format("{} at {}°", name, angle));
      Result<const TechniqueDescriptor*> technique = input.registry->technique(name);
      if (!technique) return tl::unexpected(technique.error());
      Batch batch = make_batch(input, **technique, angle, ray_case.scale);
      if (Status status = run_batch(input, **backend, maps, rays, std::move(batch), sweep); !status)
        return tl::unexpected(status.error());
    }
  }
  return sweep;
}

nlohmann::json to_json(const Sweep& sweep) {
  nlohmann::json points = nlohmann::json::array();
  for (const SweepPoint& p : sweep.points) {
    nlohmann::json point = {
        {"technique", p.technique}, {"filter", p.filter}, {"angle", p.angle}, {"wrong_percent", p.wrong_percent}};
    if (!p.loop.empty()) point.update({{"loop", p.loop}, {"count", p.count}});
    if (p.seconds >= 0) point["seconds"] = p.seconds;
    if (p.ratio >= 0) point["ratio"] = p.ratio;
    points.push_back(std::move(point));
  }
  return {
      {"case", sweep.case_name}, {"backend", sweep.backend}, {"rays", sweep.image * sweep.image}, {"points", points}};
}

}  // namespace relievo::cli
