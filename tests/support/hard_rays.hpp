/// Rays for tests of the oracle: those that break ray tracers of height maps.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "relievo/oracle.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {

/// A ray in the given direction on the uv plane, at an angle under the horizon of a map with unit height.
inline Ray slanted(double u, double v, double heading, double degrees, double slope_scale = 1) {
  const double a = degrees * std::numbers::pi / 180;
  return {u, v, 1, std::cos(heading) * std::cos(a), std::sin(heading) * std::cos(a), -std::sin(a) / slope_scale};
}

/// Rays of every kind: on grid lines and through corners, axis-parallel, vertical, horizontal, from above, from below,
/// along the plateaus, short ones. All end, so that brute force does too.
inline Ray hard_ray(Random& random, const HeightMap& map) {
  const auto coordinate = [&](int extent) {
    const int k = random.below(5);
    if (k == 0) return (random.below(extent + 2) - 0.5) / extent;  // on a grid line
    if (k == 1) return random.below(17) / 8.0 - 0.5;               // dyadic, often on the domain's side
    return random.uniform(-0.5, 1.5);
  };
  constexpr std::array heights = {1.0, 1.0, 1.0, 0.0, 0.5, 0.25, 1.25};
  Ray ray{coordinate(map.width), coordinate(map.height), heights[static_cast<std::size_t>(random.below(7))]};
  if (random.below(4) == 0) ray.h = random.uniform(-0.1, 1.2);
  if (random.below(3) == 0) ray.h += random.uniform(-3e-5, 3e-5);  // passes close to what it would have touched
  const double slope = std::exp2(random.uniform(-8, 3));
  switch (random.below(6)) {
    case 0:  // diagonal: from corner to corner where it starts on one
      ray.du = (random.below(2) ? 1.0 : -1.0) / map.width, ray.dv = (random.below(2) ? 1.0 : -1.0) / map.height;
      break;
    case 1:
      ray.du = random.below(2) ? 1 : -1;
      break;
    case 2:
      ray.dv = random.below(2) ? 1 : -1;
      break;
    case 3:
      if (random.below(4) == 0) break;  // vertical
      [[fallthrough]];
    default:
      ray.du = random.uniform(-1, 1), ray.dv = random.uniform(-1, 1);
  }
  constexpr std::array signs = {-1.0, -1.0, -1.0, 0.0, 1.0};
  ray.dh = slope * signs[static_cast<std::size_t>(random.below(5))];
  if (ray.dh == 0 && ray.du == 0 && ray.dv == 0) ray.dh = -1;
  if (ray.dh == 0 || random.below(4) == 0) ray.t_max = random.uniform(0, 4);
  if (ray.dh != 0 && std::max(std::abs(ray.du), std::abs(ray.dv)) / std::abs(ray.dh) > 100) ray.t_max = 8;
  return ray;
}

inline std::string describe(const Ray& r) {
  char text[400];
  std::snprintf(text, sizeof text, "ray %.17g %.17g %.17g + t (%.17g %.17g %.17g) to %g", r.u, r.v, r.h, r.du, r.dv,
                r.dh, r.t_max);
  return text;
}

}  // namespace relievo::test
