/// What a linear search must find, derived from the bilinear surface in double precision.
///
/// A search in steps of length s has a sample in every interval of length s. So where the ray is below the surface for
/// a whole step after its first hit at t0, the search hits, no later than that interval's end and no earlier than t0.
/// Where it dips in for less than a step it may be missed; what is then found is still below the surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "support/hard_rays.hpp"

namespace relievo::test {

/// Clearance that float arithmetic may get wrong. Coordinates of up to about 4 have an ulp of 2^-22; the steepest test
/// map falls by 1 in 1/33 of the map, so H - h is off by up to 33 * 2^-22 + a few roundings of the interpolation,
/// about 1e-5; twice that here.
inline constexpr double float_clearance = 2e-5;

inline double clearance_at(const HeightMap& map, const Ray& ray, double t) {
  return ray.h + t * ray.dh - sample_height(map, ray.u + t * ray.du, ray.v + t * ray.dv);
}

/// One ray of a linear search against the oracle's hit.
struct LinearClaim {
  bool certain = false;             ///< the search must hit, within [earliest, latest]
  double earliest = 0, latest = 0;  ///< t
};

/// `step` in t, `exit` where the search ends; `reaches_base`: there the ray meets H = 0, which is below by definition.
inline LinearClaim linear_claim(const HeightMap& map, const Ray& ray, const Hit& truth, double step, double exit,
                                bool reaches_base) {
  constexpr int samples = 64;  // a step: finer than any cell crossing that matters, as steps are under a texel
  LinearClaim claim;
  claim.earliest = truth.t;
  for (int i = 1; i <= 64 * samples && clearance_at(map, ray, claim.earliest) <= float_clearance; ++i)
    claim.earliest = std::max(0.0, truth.t - step * i / samples);
  const auto below = [&](double t) { return t >= exit ? reaches_base : clearance_at(map, ray, t) <= -float_clearance; };
  double start = truth.t;
  while (!below(start) && start < exit && start < truth.t + 8 * step) start += step / samples;
  claim.certain = true;
  for (int i = 0; i <= samples; ++i) claim.certain = claim.certain && below(start + step * i / samples);
  claim.latest = std::min(start + step, exit);
  return claim;
}

/// Rays that end within `tiles` map widths: on the base, above the lid or at t_max.
inline std::vector<Ray> bounded_rays(const HeightMap& map, int count, std::uint64_t seed, double tiles = 3) {
  Random random(seed);
  std::vector<Ray> rays;
  while (rays.size() < static_cast<std::size_t>(count)) {
    Ray ray = hard_ray(random, map);
    const double speed = std::max(std::abs(ray.du), std::abs(ray.dv));
    const double fall = std::abs(ray.dh) > 0 ? (std::abs(ray.h) + 1) / std::abs(ray.dh) : HUGE_VAL;
    if (speed * std::min(fall, ray.t_max) > tiles) ray.t_max = tiles / speed;
    rays.push_back(ray);
  }
  return rays;
}

/// Where relievo_interval (shaders/lib/interval.glsl) makes a search start and end, in double.
struct SearchRange {
  double enter = 0, exit = 0;
  bool reaches_base = false;
};

inline SearchRange search_range(const HeightMap& map, const Ray& ray) {
  SearchRange range{0, ray.t_max, false};
  if (ray.h > 1 && ray.dh < 0) range.enter = (1 - ray.h) / ray.dh;
  for (const auto& [origin, direction] : {std::pair(ray.u, ray.du), std::pair(ray.v, ray.dv)}) {
    if (map.address != AddressMode::clip || direction == 0) continue;
    const double zero = -origin / direction, one = (1 - origin) / direction;
    range.enter = std::max(range.enter, std::min(zero, one));
    range.exit = std::min(range.exit, std::max(zero, one));
  }
  const double base = ray.dh < 0 ? std::max(-ray.h / ray.dh, range.enter) : HUGE_VAL;
  if (base <= range.exit) range.exit = base, range.reaches_base = base < HUGE_VAL;
  if (ray.dh > 0) range.exit = std::min(range.exit, std::max((1 - ray.h) / ray.dh, 0.0));
  return range;
}

inline bool is_hit(const Hit& hit) {
  return hit.status == HitStatus::hit || hit.status == HitStatus::inside;
}

inline std::string describe(const Hit& hit) {
  char text[200];
  std::snprintf(text, sizeof text, "%s at t %.9g (%.9g %.9g %.9g)", std::string(to_string(hit.status)).c_str(), hit.t,
                hit.u, hit.v, hit.h);
  return text;
}

/// What comparing a search with the oracle found.
struct SearchVerdict {
  int certain = 0, found = 0;  ///< rays on which a hit is certain, and those of them that are hit in their interval
  int false_hits = 0;          ///< hits where there is no surface, or before the first one
  int other = 0;               ///< neither certain nor ambiguous: dips of less than a step
  std::string first_fault;

  void fault(const std::string& what) {
    if (first_fault.empty()) first_fault = what;
  }
};

inline SearchVerdict judge_search(const HeightMap& map, const std::vector<Ray>& rays, const std::vector<Hit>& truth,
                                  const std::vector<Hit>& measured, int steps) {
  SearchVerdict verdict;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (truth[i].ambiguous) continue;
    const SearchRange range = search_range(map, rays[i]);
    const std::string what = describe(rays[i]) + ": oracle " + describe(truth[i]) + ", found " + describe(measured[i]);
    if (!is_hit(truth[i])) {
      verdict.false_hits += is_hit(measured[i]);
      if (is_hit(measured[i])) verdict.fault("no surface there: " + what);
      continue;
    }
    const double step = std::max(range.exit - range.enter, 0.0) / steps;
    const LinearClaim claim = linear_claim(map, rays[i], truth[i], step, range.exit, range.reaches_base);
    // Rounding of t itself: relative, over a few operations.
    const double slack = 1e-5 * std::max(1.0, std::abs(claim.latest));
    if (is_hit(measured[i]) && measured[i].t < claim.earliest - slack) {
      ++verdict.false_hits;
      verdict.fault("before the first hit: " + what);
    }
    if (!claim.certain) {
      ++verdict.other;
      continue;
    }
    ++verdict.certain;
    if (is_hit(measured[i]) && measured[i].t <= claim.latest + slack)
      ++verdict.found;
    else
      verdict.fault("certain, and missed: " + what);
  }
  return verdict;
}

}  // namespace relievo::test
