#include <algorithm>
#include <memory>
#include <mutex>
#include <type_traits>

#include "c_api/boundary.hpp"
#include "c_api/heights.hpp"
#include "c_api/registry.hpp"
#include "relievo/trace.hpp"

namespace relievo::c_api {

static_assert(RELIEVO_MISS == static_cast<int>(HitStatus::miss));
static_assert(RELIEVO_HIT == static_cast<int>(HitStatus::hit));
static_assert(RELIEVO_EXHAUSTED == static_cast<int>(HitStatus::exhausted));
static_assert(RELIEVO_INSIDE == static_cast<int>(HitStatus::inside));
static_assert(RELIEVO_OUTSIDE == static_cast<int>(HitStatus::outside));
static_assert(std::is_same_v<std::underlying_type_t<HitStatus>, relievo_hit_status>);

namespace {

/// Traces on a backend, one call at a time.
class BackendTracer {
 public:
  BackendTracer(std::unique_ptr<Backend> backend, Registry registry, MapSet maps, TraceRequest request)
      : backend_(std::move(backend)),
        registry_(std::move(registry)),
        maps_(std::move(maps)),
        request_(std::move(request)) {}

  Result<std::vector<Hit>> trace(std::span<const Ray> rays) {
    const std::scoped_lock lock(mutex_);
    Result<std::vector<TraceResult>> traced = relievo::trace(*backend_, registry_, maps_, rays, {&request_, 1});
    if (!traced) return tl::unexpected(traced.error());
    return std::move(traced->front().hits);
  }

 private:
  std::mutex mutex_;
  std::unique_ptr<Backend> backend_;
  Registry registry_;
  MapSet maps_;
  TraceRequest request_;
};

}  // namespace

}  // namespace relievo::c_api

struct relievo_tracer {
  std::unique_ptr<relievo::Oracle> oracle;  ///< or:
  std::unique_ptr<relievo::c_api::BackendTracer> backend;
};

namespace relievo::c_api {

namespace {

Result<std::unique_ptr<BackendTracer>> backend_tracer(const relievo_registry& registry, const relievo_trace_desc& desc,
                                                      const HeightMap& heights) {
  if (Status status = require({{"desc.technique", desc.technique}}); !status) return tl::unexpected(status.error());
  if (Status status = require_enum("filter", desc.filter, RELIEVO_HARDWARE + 1); !status)
    return tl::unexpected(status.error());
  const Result<std::map<std::string, double>> values = values_of(registry, desc.values, desc.value_count);
  if (!values) return tl::unexpected(values.error());
  Result<std::unique_ptr<Backend>> backend = open_backend(desc.backend);
  if (!backend) return tl::unexpected(backend.error());
  TraceRequest request{desc.technique, desc.filter == RELIEVO_EXACT ? HeightFilter::exact : HeightFilter::hardware,
                       true, *values};
  auto tracer =
      std::make_unique<BackendTracer>(*std::move(backend), registry.registry, map_set(heights), std::move(request));
  const Ray vertical;  // bakes the maps, and brings every error to light
  if (const auto hits = tracer->trace({&vertical, 1}); !hits) return tl::unexpected(hits.error());
  return tracer;
}

Result<std::unique_ptr<relievo_tracer>> tracer_of(const relievo_registry& registry, const relievo_trace_desc& desc) {
  const Result<HeightMap> heights = heights_of(desc.heights, desc.width, desc.height, desc.address);
  if (!heights) return tl::unexpected(heights.error());
  auto tracer = std::make_unique<relievo_tracer>();
  if (std::string_view(desc.backend) == "oracle") {
    tracer->oracle = std::make_unique<Oracle>(*heights, OracleOptions{.threads = desc.threads});
    return tracer;
  }
  auto made = backend_tracer(registry, desc, *heights);
  if (!made) return tl::unexpected(made.error());
  tracer->backend = *std::move(made);
  return tracer;
}

Ray ray_of(const relievo_ray& ray) {
  return {ray.u, ray.v, ray.h, ray.du, ray.dv, ray.dh, ray.t_max};
}

relievo_hit hit_of(const Hit& hit) {
  return {
      static_cast<relievo_hit_status>(hit.status), hit.ambiguous, hit.t, hit.u, hit.v, hit.h, hit.steps, hit.fetches};
}

}  // namespace

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_tracer_create(const relievo_registry* registry, const relievo_trace_desc* desc,
                                     relievo_tracer** tracer, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"registry", registry}, {"desc", desc}, {"tracer", tracer}}); !status) return status;
    if (Status status = require({{"desc.backend", desc->backend}, {"desc.heights", desc->heights}}); !status)
      return status;
    auto made = tracer_of(*registry, *desc);
    if (!made) return tl::unexpected(made.error());
    *tracer = made->release();
    return {};
  });
}

void relievo_tracer_free(relievo_tracer* tracer) {
  delete tracer;
}

relievo_status relievo_tracer_trace(const relievo_tracer* tracer, const relievo_ray* rays, size_t count,
                                    relievo_hit* hits, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"tracer", tracer}}); !status) return status;
    if (Status status = require_list("rays", rays, count); !status) return status;
    if (Status status = require_list("hits", hits, count); !status) return status;
    if (count == 0) return {};
    std::vector<Ray> given(count);
    std::transform(rays, rays + count, given.begin(), ray_of);
    const Result<std::vector<Hit>> found =
        tracer->oracle ? tracer->oracle->trace(given) : tracer->backend->trace(given);
    if (!found) return tl::unexpected(found.error());
    std::transform(found->begin(), found->end(), hits, hit_of);
    return {};
  });
}
