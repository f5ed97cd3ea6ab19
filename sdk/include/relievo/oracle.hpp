/// Exact first hits against the bilinear surface, in double precision (docs/conventions.md): the third witness.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "relievo/height_map.hpp"

namespace relievo {

/// A ray in normalized tangent space (u, v, H): the point at t is origin + t·direction, 0 ≤ t ≤ t_max.
struct Ray {
  double u = 0, v = 0, h = 1;
  double du = 0, dv = 0, dh = -1;
  double t_max = std::numeric_limits<double>::infinity();
};

/// Values shared with shaders/lib/ray.glsl.
enum class HitStatus : std::int32_t {
  miss = 0,       ///< left the slab or reached t_max
  hit = 1,        ///< H(t) ≤ h(u(t),v(t)) first holds at t
  exhausted = 2,  ///< the step budget ran out; never reported as a hit
  inside = 3,     ///< starts below the surface; t = 0
  outside = 4,    ///< left the domain of a `clip` map
};
std::string_view to_string(HitStatus status);

/// Where a ray first meets the surface. u, v, h are the point origin + t·direction (t = 0 for `inside`).
/// For miss, outside and exhausted t is where the search stopped.
struct Hit {
  HitStatus status = HitStatus::miss;
  double t = 0, u = 0, v = 0, h = 0;
  std::uint32_t steps = 0;    ///< loop iterations; for the oracle, cells visited
  std::uint32_t fetches = 0;  ///< texel reads
  bool ambiguous = false;     ///< oracle only: passes within `ambiguity` of the surface before its hit without crossing
  bool sanitized = false;     ///< where costs are counted: the technique answered with NaN, and is made a miss at t = 0
};

struct OracleOptions {
  unsigned threads = 0;                ///< 0 = all
  double ambiguity = 1e-5;             ///< in H
  std::uint64_t max_cells = 1u << 24;  ///< a ray that crosses more cells is `exhausted`
};

/// First hit of one ray. The surface exists where H ≤ h(u,v): t is the smallest t ≥ 0 with H(t) ≤ h(u(t),v(t)), closed.
/// Non-finite or zero-length rays are `miss` at t = 0. With `clip`, entering the domain below the surface is a hit at
/// the entry. A ray that starts with H < h strictly is `inside`; H = h is a hit at t = 0.
/// Every const function is thread-safe, as is `to_string`.
class Oracle {
 public:
  /// Copies what it needs: the map may be freed afterwards. O(W·H) set-up.
  explicit Oracle(const HeightMap& map, OracleOptions options = {});
  ~Oracle();
  Oracle(Oracle&&) noexcept;
  Oracle& operator=(Oracle&&) noexcept;

  Hit trace(const Ray& ray) const;
  /// Traces all rays on options.threads threads; the result has one hit a ray, in order, independent of the thread
  /// count.
  std::vector<Hit> trace(std::span<const Ray> rays) const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace relievo
