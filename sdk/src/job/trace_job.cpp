/// The `ray` stage as a Job.
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "describe/origins.hpp"
#include "job/program.hpp"
#include "relievo/trace.hpp"

namespace relievo {

namespace {

constexpr int batch_binding = 1, rays_binding = 2, hits_binding = 3;
constexpr std::uint32_t group_size = 64, widest_row = 4096;

/// The rays of a set in rows of whole workgroups. Components of rays and hits are stored one after the other, each for
/// the whole grid: as planes of a buffer or as layers of an image, which is the same in bytes.
struct RayGrid {
  std::uint32_t width = 0, height = 0;
  std::size_t size() const { return std::size_t{width} * height; }
};

RayGrid grid_of(std::size_t rays) {
  const std::size_t padded = (rays + group_size - 1) / group_size * group_size;
  const std::size_t width = std::min<std::size_t>(padded, widest_row);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>((padded + width - 1) / width)};
}

/// Twins of what shaders/stages/ray/ray.glsl reads and writes. A ray has vectors of four floats, a hit words.
constexpr std::size_t ray_vectors = 2, vector_size = 4 * sizeof(float);
enum HitWord { status_word, t_word, u_word, v_word, h_word, steps_word, fetches_word, sanitized_word };

std::size_t hit_words(bool count_cost) {
  return count_cost ? sanitized_word + 1 : h_word + 1;
}

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

using RayVectors = std::array<std::array<float, 4>, ray_vectors>;

RayVectors pack(const Ray& ray, AddressMode address) {
  return {{{to_float(ray.u - tile_of(ray.u, address)), to_float(ray.v - tile_of(ray.v, address)), to_float(ray.h),
            limit_to_float(ray.t_max)},
           {to_float(ray.du), to_float(ray.dv), to_float(ray.dh), 0}}};
}

std::vector<std::byte> pack_rays(std::span<const Ray> rays, AddressMode address) {
  const std::size_t stride = grid_of(rays.size()).size() * vector_size;
  std::vector<std::byte> packed(ray_vectors * stride);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayVectors vectors = pack(rays[i], address);
    for (std::size_t k = 0; k < ray_vectors; ++k)
      std::memcpy(packed.data() + k * stride + i * vector_size, vectors[k].data(), vector_size);
  }
  return packed;
}

/// The words of one hit in a read-back.
struct PackedHit {
  std::span<const std::byte> read_back;
  std::size_t stride, index;  ///< words

  std::uint32_t word(HitWord which) const {
    const std::size_t offset = (static_cast<std::size_t>(which) * stride + index) * sizeof(std::uint32_t);
    std::uint32_t value = 0;
    if (offset < read_back.size()) std::memcpy(&value, read_back.data() + offset, sizeof value);
    return value;
  }
  float number(HitWord which) const { return std::bit_cast<float>(word(which)); }
};

/// A hit's coordinate may lack whole tiles, since in a float it is the more exact the nearer it is to 0: they are those
/// that bring it nearest to the ray, as the stage had it, at t.
double with_tiles(float coordinate, double origin, double direction, double t) {
  const double on_ray = t == 0 ? origin : origin + t * to_float(direction);
  const double tiles = std::round(on_ray - coordinate);
  return std::isfinite(tiles) ? coordinate + tiles : coordinate;
}

Hit unpack(const PackedHit& packed, const Ray& ray) {
  Hit hit;
  hit.status = static_cast<HitStatus>(packed.word(status_word));
  hit.t = packed.number(t_word);
  hit.u = with_tiles(packed.number(u_word), ray.u, ray.du, hit.t);
  hit.v = with_tiles(packed.number(v_word), ray.v, ray.dv, hit.t);
  hit.h = packed.number(h_word);
  hit.steps = packed.word(steps_word);
  hit.fetches = packed.word(fetches_word);
  hit.sanitized = packed.word(sanitized_word) != 0;
  return hit;
}

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

/// Where a request wants its rays and hits: the axis `ray.storage`.
enum class RayStorage { buffer, image };

RayStorage storage_of(const ComposedProgram& composed) {
  const auto slot = std::find_if(composed.parameters.begin(), composed.parameters.end(),
                                 [](const ParameterSlot& p) { return p.name == "ray.storage"; });
  return slot != composed.parameters.end() && slot->value == 1 ? RayStorage::image : RayStorage::buffer;
}

/// The dispatch of one request without its rays and hits.
struct RequestDispatch {
  Dispatch dispatch;
  RayStorage storage = RayStorage::buffer;
  bool count_cost = false;
};

Result<RequestDispatch> make_dispatch(const Registry& registry, const MapSet& maps, const TraceRequest& request,
                                      std::string_view shader_target, SharedPrograms& programs, Job& job) {
  Result<ComposedProgram> composed =
      compose_known(registry, permutation_of(request, maps.find("height")->second.address));
  if (!composed) return tl::unexpected(name_file_on_disk(composed.error(), registry));
  Result<int> program = programs.index_of(*composed, shader_target, job);
  if (!program) return tl::unexpected(name_file_on_disk(program.error(), registry));
  RequestDispatch made{{}, storage_of(*composed), request.count_cost};
  made.dispatch.program = *program;
  if (Status status = bind_maps(*composed, maps, job, made.dispatch.resources); !status)
    return tl::unexpected(status.error());
  bind_parameters(*composed, job, made.dispatch.resources);
  return made;
}

/// One set of rays in a job: what is asked for is made once.
class RaySet {
 public:
  RaySet(const std::vector<Ray>& rays, AddressMode address, Job& job)
      : rays_(rays), address_(address), grid_(grid_of(rays.size())), job_(job) {
    const std::array<std::uint32_t, 4> batch = {static_cast<std::uint32_t>(rays.size()),
                                                static_cast<std::uint32_t>(grid_.size()), 0, 0};
    batch_ = add(make_buffer("Batch", batch.data(), sizeof batch));
  }

  int batch() const { return batch_; }
  std::array<std::uint32_t, 3> groups() const { return {grid_.width / group_size, grid_.height, 1}; }

  int rays(RayStorage storage) {
    auto [known, is_new] = resources_.try_emplace({storage, 0});
    if (is_new) {
      known->second = add(storage, "Rays", Format::rgba32_float, ray_vectors, pack_rays(rays_, address_));
    }
    return known->second;
  }

  /// Hits that nobody reads share a resource.
  int hits(RayStorage storage, bool count_cost, bool read) {
    const std::size_t words = hit_words(count_cost);
    if (read) {
      const int made = add(storage, "Hits", Format::r32_uint, words, {});
      const auto source = storage == RayStorage::image ? ReadBack::Source::texture : ReadBack::Source::buffer;
      job_.read_backs.push_back({source, made, 0});
      return made;
    }
    auto [known, is_new] = resources_.try_emplace({storage, words});
    if (is_new) known->second = add(storage, "Hits", Format::r32_uint, words, {});
    return known->second;
  }

 private:
  int add(Buffer buffer) {
    job_.buffers.push_back(std::move(buffer));
    return static_cast<int>(job_.buffers.size()) - 1;
  }

  int add(RayStorage storage, std::string name, Format format, std::size_t components, std::vector<std::byte> data) {
    if (storage == RayStorage::buffer) {
      const std::size_t size = components * static_cast<std::size_t>(bytes_per_texel(format)) * grid_.size();
      return add({std::move(name), size, std::move(data)});
    }
    Texture texture;
    texture.name = std::move(name);
    texture.format = format;
    texture.width = static_cast<int>(grid_.width);
    texture.height = static_cast<int>(grid_.height);
    texture.depth = static_cast<int>(components);
    texture.is_array = true;
    if (!data.empty()) texture.data.push_back(std::move(data));
    job_.textures.push_back(std::move(texture));
    return static_cast<int>(job_.textures.size()) - 1;
  }

  std::span<const Ray> rays_;
  AddressMode address_;
  RayGrid grid_;
  Job& job_;
  int batch_ = 0;
  std::map<std::pair<RayStorage, std::size_t>, int> resources_;  ///< of rays, and of hits by their words
};

}  // namespace

Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const std::vector<Ray>> sets,
                           std::span<const TraceRequest> requests, std::string_view shader_target, TraceRounds rounds,
                           bool read_hits) {
  if (Status status = check_height(maps); !status) return tl::unexpected(status.error());
  Job job;
  job.name = "trace";
  std::vector<RaySet> ray_sets;
  for (const std::vector<Ray>& rays : sets) {
    if (rays.empty())
      return fail(ErrorCode::usage, "trace.no-rays", "there are no rays to trace; expected at least one");
    ray_sets.emplace_back(rays, maps.find("height")->second.address, job);
  }
  SharedPrograms programs;
  std::vector<RequestDispatch> dispatches;
  for (const TraceRequest& request : requests) {
    Result<RequestDispatch> made = make_dispatch(registry, maps, request, shader_target, programs, job);
    if (!made) return tl::unexpected(made.error());
    dispatches.push_back(std::move(*made));
  }
  std::vector<Command> round;
  for (RaySet& rays : ray_sets) {
    for (const auto& [request, storage, count_cost] : dispatches) {
      Dispatch dispatch = request;
      dispatch.resources.push_back({0, batch_binding, rays.batch()});
      dispatch.resources.push_back({0, rays_binding, rays.rays(storage)});
      dispatch.resources.push_back({0, hits_binding, rays.hits(storage, count_cost, read_hits)});
      keep_contract(job.programs[static_cast<std::size_t>(dispatch.program)], dispatch.resources);
      dispatch.groups = rays.groups();
      round.emplace_back(std::move(dispatch));
    }
  }
  if (rounds.warm_up && !round.empty())
    job.commands.assign(round.begin(), round.begin() + static_cast<std::ptrdiff_t>(requests.size()));
  for (int i = 0; i < rounds.timed; ++i) job.commands.insert(job.commands.end(), round.begin(), round.end());
  keep_filters(job);
  return job;
}

Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const Ray> rays,
                           std::span<const TraceRequest> requests, std::string_view shader_target, TraceRounds rounds) {
  const std::vector<Ray> set(rays.begin(), rays.end());
  return make_trace_job(registry, maps, {&set, 1}, requests, shader_target, rounds, true);
}

std::vector<std::vector<double>> trace_seconds(const JobResult& result, std::size_t sets, std::size_t requests,
                                               TraceRounds rounds) {
  const std::size_t a_round = sets * requests, first = rounds.warm_up && sets > 0 ? requests : 0;
  std::vector<std::vector<double>> seconds(a_round);
  for (std::size_t c = first; c < result.command_seconds.size(); ++c)
    seconds[(c - first) % a_round].push_back(result.command_seconds[c]);
  return seconds;
}

std::vector<Hit> read_hits(const std::vector<std::byte>& read_back, std::span<const Ray> rays) {
  std::vector<Hit> hits;
  hits.reserve(rays.size());
  const std::size_t stride = grid_of(rays.size()).size();
  for (std::size_t i = 0; i < rays.size(); ++i) hits.push_back(unpack({read_back, stride, i}, rays[i]));
  return hits;
}

std::vector<TraceResult> read_trace(const JobResult& result, std::span<const Ray> rays, std::size_t requests,
                                    TraceRounds rounds) {
  std::vector<std::vector<double>> seconds = trace_seconds(result, 1, requests, rounds);
  std::vector<TraceResult> traces;
  for (std::size_t k = 0; k < requests; ++k)
    traces.push_back({read_hits(result.read_backs.at(k), rays), std::move(seconds[k])});
  return traces;
}

Result<std::vector<TraceResult>> trace(Backend& backend, const Registry& registry, MapSet& maps,
                                       std::span<const Ray> rays, std::span<const TraceRequest> requests,
                                       TraceRounds rounds, std::vector<std::string>* messages) {
  for (const TraceRequest& request : requests) {
    Status baked = bake_required_maps(backend, registry, "ray", request.technique, maps, request.values, messages);
    if (!baked) return tl::unexpected(baked.error());
  }
  std::vector<TraceRequest> suited(requests.begin(), requests.end());
  for (TraceRequest& request : suited) request.values = values_on(registry, backend.info(), std::move(request.values));
  Result<Job> job = make_trace_job(registry, maps, rays, suited, backend.info().shader_target, rounds);
  if (!job) return tl::unexpected(job.error());
  Result<JobResult> result = backend.execute(*job);
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  return read_trace(*result, rays, requests.size(), rounds);
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
