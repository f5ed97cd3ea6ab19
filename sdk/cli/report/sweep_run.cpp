#include "report/sweep_run.hpp"

namespace relievo::cli {

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

Result<JobResult> trace_all(const MapRun& run, Backend& backend, std::span<const std::vector<Ray>> rays,
                            std::span<const TraceRequest> requests, TraceRounds rounds, bool count_cost) {
  Result<Job> job =
      make_trace_job(*run.input.registry, run.maps, rays, requests, backend.info().shader_target, rounds, count_cost);
  if (!job) return tl::unexpected(job.error());
  return backend.execute(*job);
}

}  // namespace relievo::cli
