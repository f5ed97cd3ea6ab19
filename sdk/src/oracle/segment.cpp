#include "oracle/segment.hpp"

#include <array>
#include <cmath>

namespace relievo::oracle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

/// A component this small against the largest moves nothing within the range of a double; as zero it takes the exact
/// axis-parallel branch instead of overflowing 1/d.
constexpr double negligible = 1e-200;

bool is_finite(const Ray& r) {
  return std::isfinite(r.u) && std::isfinite(r.v) && std::isfinite(r.h) && std::isfinite(r.du) && std::isfinite(r.dv) &&
         std::isfinite(r.dh) && !std::isnan(r.t_max);
}

Hit record(const Ray& ray, HitStatus status, double t) {
  const auto point = [t](double origin, double direction) {
    const double p = origin + t * direction;
    return std::isfinite(p) ? p : (p > 0 ? largest : p < 0 ? -largest : 0.0);
  };
  Hit hit;
  hit.status = status;
  hit.t = t;
  hit.u = point(ray.u, ray.du);
  hit.v = point(ray.v, ray.dv);
  hit.h = point(ray.h, ray.dh);
  return hit;
}

/// What never starts: reported at t = 0 without evaluating non-finite numbers.
Hit rejected(const Ray& ray) {
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
  Hit hit;
  hit.u = finite(ray.u);
  hit.v = finite(ray.v);
  hit.h = finite(ray.h);
  return hit;
}

/// Scales the direction towards 1 by a power of two, exactly, when its magnitude could overflow; returns t per τ.
double normalize_magnitude(Ray& ray) {
  const double size = std::max({std::abs(ray.du), std::abs(ray.dv), std::abs(ray.dh)});
  double scale = 1;
  if (size < 1e-60 || size > 1e60) {
    scale = std::ldexp(1.0, std::clamp(-std::ilogb(size), -1022, 1022));
    ray.t_max /= scale;
  }
  for (double* d : {&ray.du, &ray.dv, &ray.dh}) {
    *d *= scale;
    if (std::abs(*d) < negligible * (size * scale)) *d = 0;
  }
  return scale;
}

/// x = u·extent − ½ as integer and fraction. The tile is taken off before scaling, and the product's rounding error is
/// added back, so u = 10⁶ + f sees the same cells as f.
TexelCoordinate texel_coordinate(double u, const LatticeAxis& axis) {
  TexelCoordinate x;
  double in_tile = std::clamp(u, -1e290, 1e290);
  if (axis.periodic) {
    const double tile = std::floor(u);
    in_tile = u - tile;
    if (axis.cells != axis.extent && std::fmod(tile, 2.0) != 0) x.whole = axis.extent;  // a mirror image
  }
  const double product = in_tile * axis.extent;
  const double error = std::fma(in_tile, static_cast<double>(axis.extent), -product);
  const double cell = std::floor(product - 0.5);
  x.whole += cell;
  x.fraction = std::clamp((product - 0.5 - cell) + error, 0.0, 1.0);
  return x;
}

void advance(TexelCoordinate& x, double distance, const LatticeAxis& axis) {
  distance = std::clamp(distance, -1e300, 1e300);
  const double moved = x.fraction + (axis.periodic ? std::fmod(distance, static_cast<double>(axis.cells)) : distance);
  const double cells = std::floor(moved);
  x.whole += cells;
  x.fraction = moved - cells;
}

struct Interval {
  double begin = 0, end = infinity;
};

/// The part of t ≥ 0 with 0 ≤ u + t·du ≤ 1; empty when begin > end.
Interval inside_unit(double u, double du) {
  if (du == 0) return u >= 0 && u <= 1 ? Interval{} : Interval{infinity, -infinity};
  const double to_0 = (0 - u) / du, to_1 = (1 - u) / du;
  Interval interval{std::max(0.0, std::min(to_0, to_1)), std::max(to_0, to_1)};
  if (u >= 0 && u <= 1) interval.begin = 0;
  return interval;
}

/// A ray that enters a clip map's domain through a side starts exactly on that side.
void snap_to_side(TexelCoordinate& x, const LatticeAxis& axis, double d) {
  x = d > 0 ? TexelCoordinate{-1, 0.5} : TexelCoordinate{static_cast<double>(axis.extent - 1), 0.5};
}

struct Limits {
  Interval u, v;
  double begin() const { return std::max(u.begin, v.begin); }
  double end() const { return std::min(u.end, v.end); }
};

Limits domain_limits(const Lattice& lattice, const Ray& ray) {
  if (lattice.address() != AddressMode::clip) return {};
  return {inside_unit(ray.u, ray.du), inside_unit(ray.v, ray.dv)};
}

/// τ at which a ray from above comes down to the lid; 0 when it starts under it, infinite when it never comes.
double reach_lid(const Ray& ray) {
  if (ray.h <= 1) return 0;
  return ray.dh < 0 ? (1 - ray.h) / ray.dh : infinity;
}

/// Sets the segment's end: the first of floor, lid, t_max and the domain's side, in that order where they coincide.
void set_end(Segment& s, double t_max, double domain_end) {
  s.end = infinity;
  if (s.dh < 0) {
    s.end = std::max(s.h, 0.0) / -s.dh;
    s.at_end = HitStatus::hit;
  } else if (s.dh > 0) {
    s.end = (1 - s.h) / s.dh;
    s.at_end = HitStatus::miss;
  }
  if (t_max < s.end) {
    s.end = t_max;
    s.at_end = HitStatus::miss;
  }
  if (domain_end < s.end) {
    s.end = domain_end;
    s.at_end = HitStatus::outside;
  }
  s.end = std::max(s.end, 0.0);
}

Segment segment_from(const Lattice& lattice, const Ray& r, double start, const Limits& limits) {
  Segment s;
  s.x = texel_coordinate(r.u, lattice.x());
  s.y = texel_coordinate(r.v, lattice.y());
  s.dx = r.du * lattice.x().extent;
  s.dy = r.dv * lattice.y().extent;
  s.dh = r.dh;
  s.h = r.h;
  s.at_origin = start == 0;
  if (start > 0) {
    advance(s.x, s.dx * start, lattice.x());
    advance(s.y, s.dy * start, lattice.y());
    if (limits.u.begin == start) snap_to_side(s.x, lattice.x(), r.du);
    if (limits.v.begin == start) snap_to_side(s.y, lattice.y(), r.dv);
    s.h = start == reach_lid(r) ? 1.0 : std::min(r.h + r.dh * start, 1.0);
  }
  set_end(s, r.t_max - start, limits.end() - start);
  return s;
}

}  // namespace

std::variant<Segment, Hit> make_segment(const Lattice& lattice, const Ray& ray) {
  if (!is_finite(ray) || (ray.du == 0 && ray.dv == 0 && ray.dh == 0) || ray.t_max < 0) return rejected(ray);
  Ray scaled = ray;
  const double t_per_tau = normalize_magnitude(scaled);
  const auto stop = [&](HitStatus status, double tau) {
    return record(ray, status, std::min(std::min(tau * t_per_tau, ray.t_max), largest));
  };
  const Limits limits = domain_limits(lattice, scaled);
  const double lid = reach_lid(scaled);
  if (limits.begin() > limits.end() || limits.begin() == infinity) return stop(HitStatus::outside, 0);
  if (limits.begin() > scaled.t_max) return stop(HitStatus::miss, scaled.t_max);
  const double height_at_entry = scaled.h + scaled.dh * limits.begin();
  if (lid == infinity || (scaled.dh > 0 && height_at_entry > 1)) return stop(HitStatus::miss, limits.begin());
  const double start = std::max(limits.begin(), lid);
  if (start > std::min(scaled.t_max, limits.end()))
    return scaled.t_max <= limits.end() ? stop(HitStatus::miss, scaled.t_max) : stop(HitStatus::outside, limits.end());
  Segment segment = segment_from(lattice, scaled, start, limits);
  segment.t_per_tau = t_per_tau;
  segment.t_start = start * t_per_tau;
  return segment;
}

Hit hit_at(const Segment& segment, const Ray& ray, HitStatus status, double tau) {
  const double t = segment.t_start + tau * segment.t_per_tau;
  return record(ray, status, std::min(std::min(t, ray.t_max), largest));
}

}  // namespace relievo::oracle
