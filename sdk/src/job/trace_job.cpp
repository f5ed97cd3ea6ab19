/// The `ray` stage as a Job.
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "job/program.hpp"
#include "relievo/trace.hpp"

namespace relievo {

namespace {

/// Twins of the structures in shaders/stages/ray/ray.glsl.
struct PackedRay {
  float u, v, h, t_max;
  float du, dv, dh, unused;
};
struct PackedHit {
  std::int32_t status;
  float t, u, v, h;
  std::uint32_t steps, fetches, unused;
};
static_assert(sizeof(PackedRay) == 32 && sizeof(PackedHit) == 32);

constexpr int batch_binding = 1, rays_binding = 2, hits_binding = 3;
constexpr std::uint32_t group_size = 64, widest_row = 32768;

/// Whole tiles that a coordinate can shed without changing what it reads (lib/address.glsl has the twin).
double tile_of(double coordinate, AddressMode address) {
  if (!std::isfinite(coordinate)) return 0;
  if (address == AddressMode::repeat) return std::floor(coordinate);
  if (address == AddressMode::mirror) return 2 * std::floor(coordinate / 2);
  return 0;
}

constexpr double largest_float = std::numeric_limits<float>::max();

/// What is not finite stays so, for the stage to refuse.
float to_float(double value) {
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -largest_float, largest_float) : value);
}

/// No limit is the largest float on the other side (RELIEVO_NO_LIMIT).
float limit_to_float(double t_max) {
  return to_float(t_max > largest_float ? largest_float : t_max);
}

PackedRay pack(const Ray& ray, AddressMode address) {
  return {to_float(ray.u - tile_of(ray.u, address)),
          to_float(ray.v - tile_of(ray.v, address)),
          to_float(ray.h),
          limit_to_float(ray.t_max),
          to_float(ray.du),
          to_float(ray.dv),
          to_float(ray.dh),
          0};
}

Hit unpack(const PackedHit& packed, const Ray& ray, AddressMode address) {
  Hit hit;
  hit.status = static_cast<HitStatus>(packed.status);
  hit.t = packed.t;
  hit.u = packed.u + tile_of(ray.u, address);
  hit.v = packed.v + tile_of(ray.v, address);
  hit.h = packed.h;
  hit.steps = packed.steps;
  hit.fetches = packed.fetches;
  return hit;
}

Buffer pack_rays(std::span<const Ray> rays, AddressMode address) {
  std::vector<PackedRay> packed;
  packed.reserve(rays.size());
  for (const Ray& ray : rays) packed.push_back(pack(ray, address));
  return make_buffer("Rays", packed.data(), packed.size() * sizeof(PackedRay));
}

std::array<std::uint32_t, 3> groups_for(std::size_t rays) {
  std::uint32_t groups = static_cast<std::uint32_t>((rays + group_size - 1) / group_size);
  std::uint32_t row = std::min(groups, widest_row);
  return {row, (groups + row - 1) / row, 1};
}

/// The programs of a job. Permutations that differ in uniform values alone share one: it is compiled once, by us and by
/// the driver.
class SharedPrograms {
 public:
  Result<int> index_of(const ComposedProgram& composed, std::string_view shader_target, Job& job) {
    auto [known, is_new] = indices_.try_emplace(identity(composed), static_cast<int>(job.programs.size()));
    if (!is_new) return known->second;
    Result<PreparedProgram> prepared = prepare_composed(composed, shader_target);
    if (!prepared) return tl::unexpected(prepared.error());
    job.programs.push_back(std::move(prepared->program));
    return known->second;
  }

 private:
  static std::string identity(const ComposedProgram& composed) {
    std::string text;
    for (const ComposedShader& shader : composed.shaders) text += shader.text;
    for (const ParameterSlot& slot : composed.parameters) {
      if (slot.binding == BindingTime::specialization) text += fmt::format("/{}={}", slot.constant_id, slot.value);
    }
    return text;
  }

  std::map<std::string, int> indices_;
};

Permutation permutation_of(const TraceRequest& request, AddressMode address) {
  Permutation permutation;
  permutation.stage = "ray";
  permutation.roles["view"] = request.technique;
  permutation.filter = request.filter;
  permutation.address = address;
  permutation.count_cost = request.count_cost;
  permutation.values = request.values;
  return permutation;
}

/// The dispatch of one request without its rays and hits.
Result<Dispatch> make_dispatch(const Registry& registry, const MapSet& maps, const TraceRequest& request,
                               std::string_view shader_target, SharedPrograms& programs, Job& job) {
  Result<ComposedProgram> composed =
      compose_known(registry, permutation_of(request, maps.find("height")->second.address));
  if (!composed) return tl::unexpected(composed.error());
  Result<int> program = programs.index_of(*composed, shader_target, job);
  if (!program) return tl::unexpected(program.error());
  Dispatch dispatch;
  dispatch.program = *program;
  bind_maps(*composed, maps, job, dispatch.resources);
  bind_parameters(*composed, job, dispatch.resources);
  return dispatch;
}

/// Buffers of one set of rays.
struct SetBuffers {
  int batch = 0, rays = 0, hits = -1;
};

SetBuffers add_set(const std::vector<Ray>& rays, AddressMode address, Job& job) {
  std::array<std::uint32_t, 4> count = {static_cast<std::uint32_t>(rays.size()), 0, 0, 0};
  SetBuffers set;
  set.batch = static_cast<int>(job.buffers.size());
  job.buffers.push_back(make_buffer("Batch", count.data(), sizeof(count)));
  set.rays = static_cast<int>(job.buffers.size());
  job.buffers.push_back(pack_rays(rays, address));
  return set;
}

/// Hits that nobody reads share a buffer.
int hits_buffer(SetBuffers& set, std::size_t rays, bool read_hits, Job& job) {
  if (set.hits >= 0 && !read_hits) return set.hits;
  set.hits = static_cast<int>(job.buffers.size());
  job.buffers.push_back({"Hits", rays * sizeof(PackedHit), {}});
  if (read_hits) job.read_backs.push_back({ReadBack::Source::buffer, set.hits, 0});
  return set.hits;
}

}  // namespace

Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const std::vector<Ray>> sets,
                           std::span<const TraceRequest> requests, std::string_view shader_target, int repeats,
                           bool read_hits) {
  Job job;
  job.name = "trace";
  std::vector<SetBuffers> buffers;
  for (const std::vector<Ray>& rays : sets) {
    if (rays.empty())
      return fail(ErrorCode::usage, "trace.no-rays", "there are no rays to trace; expected at least one");
    buffers.push_back(add_set(rays, maps.find("height")->second.address, job));
  }
  SharedPrograms programs;
  std::vector<Dispatch> dispatches;
  for (const TraceRequest& request : requests) {
    Result<Dispatch> dispatch = make_dispatch(registry, maps, request, shader_target, programs, job);
    if (!dispatch) return tl::unexpected(dispatch.error());
    dispatches.push_back(std::move(*dispatch));
  }
  std::vector<Command> round;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (Dispatch dispatch : dispatches) {
      dispatch.resources.push_back({0, batch_binding, buffers[s].batch});
      dispatch.resources.push_back({0, rays_binding, buffers[s].rays});
      dispatch.resources.push_back({0, hits_binding, hits_buffer(buffers[s], sets[s].size(), read_hits, job)});
      keep_contract(job.programs[static_cast<std::size_t>(dispatch.program)], dispatch.resources);
      dispatch.groups = groups_for(sets[s].size());
      round.emplace_back(std::move(dispatch));
    }
  }
  for (int i = 0; i < repeats; ++i) job.commands.insert(job.commands.end(), round.begin(), round.end());
  return job;
}

Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const Ray> rays,
                           std::span<const TraceRequest> requests, std::string_view shader_target, int repeats) {
  const std::vector<Ray> set(rays.begin(), rays.end());
  return make_trace_job(registry, maps, {&set, 1}, requests, shader_target, repeats, true);
}

std::vector<Hit> read_hits(const std::vector<std::byte>& read_back, std::span<const Ray> rays, AddressMode address) {
  std::vector<Hit> hits;
  hits.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    PackedHit packed;
    std::memcpy(&packed, read_back.data() + i * sizeof(PackedHit), sizeof(PackedHit));
    hits.push_back(unpack(packed, rays[i], address));
  }
  return hits;
}

std::vector<TraceResult> read_trace(const Job& job, const JobResult& result, std::span<const Ray> rays,
                                    AddressMode address, std::size_t requests) {
  std::vector<TraceResult> traces(requests);
  for (std::size_t k = 0; k < requests; ++k) {
    traces[k].hits = read_hits(result.read_backs.at(k), rays, address);
    for (std::size_t c = k; c < job.commands.size() && c < result.command_seconds.size(); c += requests) {
      traces[k].seconds.push_back(result.command_seconds[c]);
    }
  }
  return traces;
}

Result<std::vector<TraceResult>> trace(Backend& backend, const Registry& registry, MapSet& maps,
                                       std::span<const Ray> rays, std::span<const TraceRequest> requests, int repeats,
                                       std::vector<std::string>* messages) {
  for (const TraceRequest& request : requests) {
    Result<std::vector<std::string>> needed = required_maps(registry, "ray", request.technique);
    if (!needed) return tl::unexpected(needed.error());
    for (const std::string& map : *needed) {
      if (Status status = bake_map(backend, registry, map, maps, request.values, messages); !status)
        return tl::unexpected(status.error());
    }
  }
  Result<Job> job = make_trace_job(registry, maps, rays, requests, backend.info().shader_target, repeats);
  if (!job) return tl::unexpected(job.error());
  Result<JobResult> result = backend.execute(*job);
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  return read_trace(*job, *result, rays, maps.at("height").address, requests.size());
}

namespace {

/// What a shader gets, so that the oracle judges the same ray: in float32 a ray moves by up to 6e-5 texels of 1024.
double in_float32(double x) {
  return static_cast<double>(static_cast<float>(x));
}

}  // namespace

std::vector<Ray> make_view_rays(double angle_degrees, double scale, int width, int height) {
  constexpr double pi = 3.14159265358979323846, field_of_view = 2.0;  // degrees across the image
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    double row = (y + 0.5) / height, pitch = (angle_degrees + field_of_view * (row - 0.5)) * pi / 180;
    pitch = std::fmax(pitch, 0.02 * pi / 180);
    for (int x = 0; x < width; ++x) {
      double column = (x + 0.5) / width, yaw = (30 + field_of_view * (column - 0.5)) * pi / 180;
      Ray ray;
      ray.u = in_float32(column);
      ray.v = in_float32(row);
      ray.du = in_float32(std::cos(pitch) * std::cos(yaw));
      ray.dv = in_float32(std::cos(pitch) * std::sin(yaw));
      ray.dh = in_float32(-std::sin(pitch) / scale);
      rays.push_back(ray);
    }
  }
  return rays;
}

}  // namespace relievo
