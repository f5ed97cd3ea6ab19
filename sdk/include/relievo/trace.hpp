/// Rays in, hits out, on a backend: the `ray` stage as a Job.
/// Every function here is thread-safe; `trace` changes its maps and messages, with a backend that no other thread uses
/// meanwhile.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "relievo/backend.hpp"
#include "relievo/compile.hpp"
#include "relievo/maps.hpp"
#include "relievo/oracle.hpp"

namespace relievo {

/// One technique with its settings.
struct TraceRequest {
  std::string technique;
  HeightFilter filter = HeightFilter::exact;
  bool count_cost = true;                ///< count steps and fetches; off for timing
  std::map<std::string, double> values;  ///< "owner.parameter"; those of other owners are ignored
};

/// A composed and compiled permutation in the form that Jobs carry.
struct PreparedProgram {
  ComposedProgram composed;
  ShaderProgram program;
};

/// Composes and compiles for what a backend consumes (BackendInfo::shader_target, "spirv" or a target's name).
/// `values` of owners that the permutation has not are dropped.
Result<PreparedProgram> prepare(const Registry& registry, Permutation permutation, std::string_view shader_target);

/// `values`, and for axes that they leave open what suits the backend's device: on a software driver the value that the
/// descriptor has for one (Parameter::software_value), if the backend has its features. `trace` and `render` do.
std::map<std::string, double> values_on(const Registry& registry, const BackendInfo& backend,
                                        std::map<std::string, double> values);

/// How often a Job traces.
struct TraceRounds {
  int timed = 1;  ///< rounds over all sets of rays and all requests
  /// Before them each request over the first set, not timed: drivers compile what they run first.
  bool warm_up = false;
};

/// A Job that traces all rays with each request in turn, round after round.
/// Rays keep their order; whole tiles of u and v are split off first, so that uv may be far from 0.
/// `maps` holds every map that the techniques require. Errors: as of compose and compile; "trace.no-rays".
Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const Ray> rays,
                           std::span<const TraceRequest> requests, std::string_view shader_target,
                           TraceRounds rounds = {});

/// The same for several sets of rays: requests that differ in uniform values alone share a program, and all sets do.
/// After the warm-up, command (round · sets + s) · requests + k traces set s with request k. With `read_hits`,
/// read-back s · requests + k holds its hits; without, nothing is read back, and the job's times are all that is wanted
/// of it.
Result<Job> make_trace_job(const Registry& registry, const MapSet& maps, std::span<const std::vector<Ray>> sets,
                           std::span<const TraceRequest> requests, std::string_view shader_target, TraceRounds rounds,
                           bool read_hits);

/// What each timed round of such a job took for each set and request: `seconds[s · requests + k]`, one value a round,
/// by the GPU's clock; empty without timestamps.
std::vector<std::vector<double>> trace_seconds(const JobResult& result, std::size_t sets, std::size_t requests,
                                               TraceRounds rounds);

/// The hits in one read-back of such a job; u and v in the rays' own tiles.
std::vector<Hit> read_hits(const std::vector<std::byte>& read_back, std::span<const Ray> rays);

struct TraceResult {
  std::vector<Hit> hits;        ///< one a ray; u and v in the rays' own tiles
  std::vector<double> seconds;  ///< one a timed round, by the GPU's clock; empty without timestamps
};

/// What each request found, from the result of a job with one set of rays.
std::vector<TraceResult> read_trace(const JobResult& result, std::span<const Ray> rays, std::size_t requests,
                                    TraceRounds rounds = {});

/// Bakes what is missing in `maps`, makes the job and runs it. `messages` receives validation and debug output.
Result<std::vector<TraceResult>> trace(Backend& backend, const Registry& registry, MapSet& maps,
                                       std::span<const Ray> rays, std::span<const TraceRequest> requests,
                                       TraceRounds rounds = {}, std::vector<std::string>* messages = nullptr);

/// An image of rays that look down at `angle` degrees above the base plane on a map whose lid is `scale` texture widths
/// high, with a little perspective: `width`×`height` rays, row by row, each starting on the lid. All numbers
/// are floats, so that a shader and the oracle get the same rays.
std::vector<Ray> make_view_rays(double angle_degrees, double scale, int width = 1024, int height = 1024);

}  // namespace relievo
