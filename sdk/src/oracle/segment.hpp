/// The part of a ray that can meet the surface: inside the slab 0 ≤ H ≤ 1, inside a clip map's domain, up to t_max.
#pragma once

#include <variant>

#include "oracle/lattice.hpp"
#include "relievo/oracle.hpp"

namespace relievo::oracle {

/// A texel coordinate, as an integer and a fraction in [0,1], so that its distance to grid lines keeps full precision.
struct TexelCoordinate {
  double whole = 0, fraction = 0;
};

/// A ray made ready for walking: texel units, starting on the segment; time τ counts from there.
struct Segment {
  TexelCoordinate x, y;
  double h = 0;           ///< exactly 1 where the ray comes down through the lid
  double dx = 0, dy = 0;  ///< texels per τ
  double dh = 0;
  double end = 0;                      ///< last τ; infinite for a horizontal ray without t_max
  HitStatus at_end = HitStatus::miss;  ///< what the ray is when nothing was met: `hit` at the floor, where h ≥ 0 = H
  bool at_origin = true;               ///< starts at the ray's origin, so that a start below the surface is `inside`
  double t_start = 0;
  double t_per_tau = 1;  ///< a power of two: direction components of any magnitude stay in range

  /// Height at τ. At the floor's τ the rounded value may miss 0 by an ulp; `at_end` settles it.
  double height(double tau) const { return h + dh * tau; }
};

/// The segment, or the hit record of a ray that has none.
std::variant<Segment, Hit> make_segment(const Lattice& lattice, const Ray& ray);

/// The record for a search that stopped at τ of the segment.
Hit hit_at(const Segment& segment, const Ray& ray, HitStatus status, double tau);

}  // namespace relievo::oracle
