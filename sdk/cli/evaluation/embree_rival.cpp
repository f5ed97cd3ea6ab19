#include "evaluation/embree_rival.hpp"

#include <fmt/format.h>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "common.hpp"

#if RELIEVO_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

namespace relievo::cli {

#if RELIEVO_HAS_EMBREE

namespace {

constexpr std::size_t chunk = 1024;  // rays that a thread takes at a time, and that a stream holds
constexpr float no_limit = std::numeric_limits<float>::infinity();

/// Bytes that Embree says it holds.
struct Memory {
  std::atomic<std::ptrdiff_t> now{0}, peak{0};

  static bool add(void* self, ssize_t bytes, bool) {
    auto& memory = *static_cast<Memory*>(self);
    const std::ptrdiff_t now = memory.now += bytes;
    for (std::ptrdiff_t peak = memory.peak; now > peak && !memory.peak.compare_exchange_weak(peak, now);) {
    }
    return true;
  }
};

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Scene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

/// A ray in the space of the triangles, (u, v, scale · H), within the tile that it is in.
struct TileRay {
  float origin[3], direction[3];
  float end;  ///< t where it is below the base or ends
};

struct TileHit {
  float t = no_limit;  ///< infinite: none
};

/// The centres of texel 0 to texel W (which is texel 0 again): one tile of a map that repeats.
RTCGeometry make_triangles(RTCDevice device, const HeightMap& map, double scale) {
  const auto columns = static_cast<unsigned>(map.width) + 1, rows = static_cast<unsigned>(map.height) + 1;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, std::size_t{columns} * rows));
  auto* index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                              2 * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height)));
  if (vertex == nullptr || index == nullptr) return geometry;  // the device has the error
  for (unsigned j = 0; j < rows; ++j) {
    for (unsigned i = 0; i < columns; ++i) {
      const int x = static_cast<int>(i) % map.width, y = static_cast<int>(j) % map.height;
      *vertex++ = static_cast<float>((i + 0.5) / map.width);
      *vertex++ = static_cast<float>((j + 0.5) / map.height);
      *vertex++ = static_cast<float>(scale * static_cast<double>(map.at(x, y)));
      if (i + 1 == columns || j + 1 == rows) continue;
      const unsigned corner = j * columns + i;
      for (const unsigned k :
           {corner, corner + 1, corner + columns, corner + 1, corner + columns + 1, corner + columns})
        *index++ = k;
    }
  }
  return geometry;
}

/// Moves a ray that has hit nothing into the tile that it enters next; false when it ends before.
bool enter_next_tile(TileRay& ray, const HeightMap& map) {
  const double low[] = {0.5 / map.width, 0.5 / map.height};
  double at[2];
  for (int k = 0; k < 2; ++k) {
    const double d = ray.direction[k], border = low[k] + (d > 0 ? 1 : 0);
    at[k] = d != 0 ? (border - static_cast<double>(ray.origin[k])) / d : std::numeric_limits<double>::infinity();
  }
  const int axis = at[0] <= at[1] ? 0 : 1;
  if (!(at[axis] < static_cast<double>(ray.end))) return false;
  ray.origin[axis] -= ray.direction[axis] > 0 ? 1.0f : -1.0f;
  return true;
}

std::vector<TileRay> tile_rays(std::span<const Ray> rays, const HeightMap& map, double scale) {
  std::vector<TileRay> result;
  result.reserve(rays.size());
  for (const Ray& r : rays) {
    const double u = r.u - std::floor(r.u - 0.5 / map.width), v = r.v - std::floor(r.v - 0.5 / map.height);
    const double base = r.dh < 0 ? -r.h / r.dh * (1 + 1e-6) : r.dh > 0 ? std::max(0.0, (1 - r.h) / r.dh) : r.t_max;
    result.push_back({{static_cast<float>(u), static_cast<float>(v), static_cast<float>(scale * r.h)},
                      {static_cast<float>(r.du), static_cast<float>(r.dv), static_cast<float>(scale * r.dh)},
                      static_cast<float>(std::min({base, r.t_max, 1e6}))});
  }
  return result;
}

/// A ray as Embree wants it, alone or as one of a stream.
RTCRayHit query_of(const TileRay& r) {
  RTCRayHit query{};
  query.ray.org_x = r.origin[0], query.ray.org_y = r.origin[1], query.ray.org_z = r.origin[2];
  query.ray.dir_x = r.direction[0], query.ray.dir_y = r.direction[1], query.ray.dir_z = r.direction[2];
  query.ray.tfar = r.end;
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

struct Question {
  RTCScene scene;
  const HeightMap& map;
  bool coherent;

  RTCIntersectContext context() const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
  }
};

void trace_single(const Question& question, std::span<TileRay> rays, std::span<TileHit> hits) {
  RTCIntersectContext context = question.context();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    do {
      RTCRayHit query = query_of(rays[i]);
      rtcIntersect1(question.scene, &context, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      hits[i].t = query.ray.tfar;
      break;
    } while (enter_next_tile(rays[i], question.map));
  }
}

void trace_packets(const Question& question, std::span<TileRay> rays, std::span<TileHit> hits) {
  constexpr std::size_t lanes = 8;
  RTCIntersectContext context = question.context();
  for (std::size_t start = 0; start < rays.size(); start += lanes) {
    const std::size_t count = std::min(lanes, rays.size() - start);
    alignas(32) int valid[lanes] = {};
    for (std::size_t k = 0; k < count; ++k) valid[k] = -1;
    for (bool any = true; any;) {
      RTCRayHit8 query;
      for (std::size_t k = 0; k < lanes; ++k) {
        const TileRay& r = rays[start + std::min(k, count - 1)];
        query.ray.org_x[k] = r.origin[0], query.ray.org_y[k] = r.origin[1], query.ray.org_z[k] = r.origin[2];
        query.ray.dir_x[k] = r.direction[0], query.ray.dir_y[k] = r.direction[1], query.ray.dir_z[k] = r.direction[2];
        query.ray.tnear[k] = 0, query.ray.tfar[k] = r.end, query.ray.time[k] = 0;
        query.ray.mask[k] = ~0u, query.ray.id[k] = 0, query.ray.flags[k] = 0;
        query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, question.scene, &context, &query);
      any = false;
      for (std::size_t k = 0; k < count; ++k) {
        if (valid[k] == 0) continue;
        const bool is_hit = query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
        if (is_hit) hits[start + k].t = query.ray.tfar[k];
        if (is_hit || !enter_next_tile(rays[start + k], question.map)) valid[k] = 0;
        any = any || valid[k] != 0;
      }
    }
  }
}

void trace_stream(const Question& question, std::span<TileRay> rays, std::span<TileHit> hits) {
  RTCIntersectContext context = question.context();
  std::array<RTCRayHit, chunk> queries;
  std::array<std::size_t, chunk> open;  // rays that have not ended
  std::size_t count = rays.size();
  for (std::size_t i = 0; i < count; ++i) open[i] = i;
  while (count > 0) {
    for (std::size_t k = 0; k < count; ++k) queries[k] = query_of(rays[open[k]]);
    rtcIntersect1M(question.scene, &context, queries.data(), static_cast<unsigned>(count), sizeof(RTCRayHit));
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = open[k];
      if (queries[k].hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        hits[i].t = queries[k].ray.tfar;
      } else if (enter_next_tile(rays[i], question.map)) {
        open[left++] = i;
      }
    }
    count = left;
  }
}

struct Method {
  const char* name;
  void (*trace)(const Question&, std::span<TileRay>, std::span<TileHit>);
  bool coherent;
};
constexpr std::array methods = {
    Method{"rtcIntersect1", trace_single, false}, Method{"rtcIntersect8", trace_packets, false},
    Method{"rtcIntersect8 coherent", trace_packets, true}, Method{"rtcIntersect1M", trace_stream, false},
    Method{"rtcIntersect1M coherent", trace_stream, true}};

/// Seconds for all rays; the copy of the rays, which the tracing moves from tile to tile, is made before.
double time_once(const Method& method, const Question& question, std::vector<TileRay> rays, std::vector<TileHit>& hits,
                 unsigned threads) {
  hits.assign(rays.size(), {});
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t start = next.fetch_add(chunk); start < rays.size(); start = next.fetch_add(chunk)) {
      const std::size_t count = std::min(chunk, rays.size() - start);
      method.trace(question, std::span(rays).subspan(start, count), std::span(hits).subspan(start, count));
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<Hit> to_hits(std::span<const Ray> rays, const std::vector<TileHit>& found) {
  std::vector<Hit> hits(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& r = rays[i];
    if (!std::isfinite(found[i].t)) continue;
    const double t = static_cast<double>(found[i].t);
    hits[i] = {HitStatus::hit, t, r.u + t * r.du, r.v + t * r.dv, r.h + t * r.dh};
  }
  return hits;
}

tl::unexpected<Error> embree_error(RTCDevice device, const char* what) {
  return fail(ErrorCode::backend, "bench.embree",
              fmt::format("Embree {}: error {}", what, static_cast<int>(rtcGetDeviceError(device))));
}

}  // namespace

Result<RivalResult> race_embree(const HeightMap& map, double scale, std::span<const Ray> rays, unsigned threads,
                                int repeats, const std::function<Status()>& before_round) {
  if (map.address != AddressMode::repeat) {
    return fail(ErrorCode::usage, "bench.embree-address",
                fmt::format("Embree is compared on maps that repeat; the address mode is {}", to_string(map.address)));
  }
  Memory memory;  // outlives the device, which reports to it
  const Device device(rtcNewDevice(fmt::format("threads={}", threads).c_str()));
  if (!device) return embree_error(nullptr, "makes no device");
  rtcSetDeviceMemoryMonitorFunction(device.get(), Memory::add, &memory);
  RivalResult result;
  const auto start = std::chrono::steady_clock::now();
  const Scene scene(rtcNewScene(device.get()));
  RTCGeometry geometry = make_triangles(device.get(), map, scale);
  result.triangle_bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(memory.now, 0));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) return embree_error(device.get(), "builds no scene");
  result.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(memory.now, 0));
  result.peak_bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(memory.peak, 0));
  const std::vector<TileRay> prepared = tile_rays(rays, map, scale);
  for (const Method& method : methods) result.runs.push_back({method.name, {}, {}});
  std::vector<TileHit> hits;
  for (int k = 0; k < repeats; ++k) {  // interleaved, as techniques are
    if (Status status = before_round(); !status) return tl::unexpected(status.error());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      result.runs[m].seconds.push_back(
          time_once(methods[m], {scene.get(), map, methods[m].coherent}, prepared, hits, threads));
      if (k == 0) result.runs[m].hits = to_hits(rays, hits);
    }
  }
  for (std::size_t m = 1; m < methods.size(); ++m) {
    if (median(result.runs[m].seconds) < median(result.runs[result.fastest].seconds)) result.fastest = m;
  }
  return result;
}

#else

Result<RivalResult> race_embree(const HeightMap&, double, std::span<const Ray>, unsigned, int,
                                const std::function<Status()>&) {
  return fail(ErrorCode::unsupported, "bench.no-embree",
              "this program was built without Embree 3; expected its development package when it is configured");
}

#endif

}  // namespace relievo::cli
