/// First hits by brute force in long double, independent of the oracle: its own address modes, every crossing solved
/// apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/oracle.hpp"

namespace relievo::test {

using Real = long double;

struct BruteForceHit {
  HitStatus status = HitStatus::miss;
  Real t = 0;
  bool ambiguous = false;
};

class BruteForce {
 public:
  explicit BruteForce(const HeightMap& map) : map_(map) {}

  /// For rays with finite numbers, a direction, and an end: slanted, or with t_max, or leaving a clip map.
  BruteForceHit trace(const Ray& ray, Real ambiguity = 1e-5L) const;
  Real clearance(const Ray& ray, Real t) const { return height(ray, t) - surface(x(ray, t), y(ray, t)); }
  /// Bilinear height at texel coordinates.
  Real surface(Real px, Real py) const {
    return patch(static_cast<long long>(std::floor(px)), static_cast<long long>(std::floor(py)), px, py);
  }
  /// h00 − h10 − h01 + h11 of the cell at texel coordinates.
  Real twist(Real px, Real py) const {
    const auto i = static_cast<long long>(std::floor(px)), j = static_cast<long long>(std::floor(py));
    return texel(i, j) - texel(i + 1, j) - texel(i, j + 1) + texel(i + 1, j + 1);
  }

 private:
  struct Range {
    Real begin = 0, end = HUGE_VALL;
    HitStatus at_end = HitStatus::miss;
    bool empty = false;
  };
  /// Clearance at the ends and the middle of an interval in which the ray stays within one cell: a quadratic.
  struct Piece {
    Real begin = 0, end = 0;
    Real c0 = 0, c1 = 0, c2 = 0;  ///< of s in [0,1]
    Real at(Real s) const { return c0 + s * (c1 + s * c2); }
    Real turn() const { return c2 != 0 ? -c1 / (2 * c2) : -1; }
  };

  static int wrap(long long i, int n, AddressMode mode) {
    if (mode == AddressMode::clamp || mode == AddressMode::clip)
      return static_cast<int>(i < 0 ? 0 : i >= n ? n - 1 : i);
    while (i < 0) i += 2LL * n * (1 + -i / (2LL * n));
    if (mode == AddressMode::mirror && (i / n) % 2 == 1) return static_cast<int>(n - 1 - i % n);
    return static_cast<int>(i % n);
  }
  Real x(const Ray& r, Real t) const { return (Real(r.u) + t * r.du) * map_.width - 0.5L; }
  Real y(const Ray& r, Real t) const { return (Real(r.v) + t * r.dv) * map_.height - 0.5L; }
  static Real height(const Ray& r, Real t) { return Real(r.h) + t * r.dh; }
  Real texel(long long i, long long j) const {
    return map_.at(wrap(i, map_.width, map_.address), wrap(j, map_.height, map_.address));
  }
  /// Bilinear patch of one cell; holds beyond it too.
  Real patch(long long i, long long j, Real px, Real py) const {
    const Real a = px - Real(i), b = py - Real(j);
    const Real low = texel(i, j) * (1 - a) + texel(i + 1, j) * a;
    return low * (1 - b) + (texel(i, j + 1) * (1 - a) + texel(i + 1, j + 1) * a) * b;
  }

  Range range_of(const Ray& ray) const;
  void limit_to_domain(Real origin, Real direction, Range& range) const;
  std::vector<Real> crossings(const Ray& ray, const Range& range) const;
  Piece piece(const Ray& ray, Real begin, Real end) const;
  static Real first_root(const Piece& piece);
  static bool stays_near_after(const std::vector<Piece>& pieces, std::size_t k, Real s, Real depth, HitStatus at_end);

  const HeightMap& map_;
};

inline void BruteForce::limit_to_domain(Real origin, Real direction, Range& range) const {
  if (direction == 0) {
    if (origin < 0 || origin > 1) range.end = -1;
    return;
  }
  const Real a = -origin / direction, b = (1 - origin) / direction;
  range.begin = std::max(range.begin, std::min(a, b));
  range.end = std::min(range.end, std::max(a, b));
}

/// The part of the ray within the domain, the slab and t_max; where there is none, what comes first ends the ray.
inline BruteForce::Range BruteForce::range_of(const Ray& ray) const {
  Range range{0, HUGE_VALL, HitStatus::outside, false};
  if (map_.address == AddressMode::clip) {
    limit_to_domain(ray.u, ray.du, range);
    limit_to_domain(ray.v, ray.dv, range);
  }
  const auto nothing = [](HitStatus status) { return Range{0, 0, status, true}; };
  if (range.begin > range.end) return nothing(HitStatus::outside);
  if (range.begin > ray.t_max) return nothing(HitStatus::miss);
  if (ray.t_max <= range.end) range.end = ray.t_max, range.at_end = HitStatus::miss;
  if (height(ray, range.begin) > 1) {
    if (ray.dh >= 0) return nothing(HitStatus::miss);
    range.begin = (1 - Real(ray.h)) / ray.dh;
    if (range.begin > range.end) return nothing(range.at_end);
  }
  const Real top = ray.dh > 0 ? (1 - Real(ray.h)) / ray.dh : HUGE_VALL;
  const Real floor = ray.dh < 0 ? std::max(range.begin, -Real(ray.h) / ray.dh) : HUGE_VALL;
  if (top <= range.end) range.end = top, range.at_end = HitStatus::miss;
  if (floor <= range.end) range.end = floor, range.at_end = HitStatus::hit;
  return range;
}

inline std::vector<Real> BruteForce::crossings(const Ray& ray, const Range& range) const {
  std::vector<Real> times = {range.begin, range.end};
  const auto add_lines = [&](Real from, Real to, Real origin, Real direction) {
    for (Real line = std::ceil(std::min(from, to)); line <= std::max(from, to); line += 1) {
      const Real t = (line - origin) / direction;
      if (t > range.begin && t < range.end) times.push_back(t);
    }
  };
  if (ray.du != 0) add_lines(x(ray, range.begin), x(ray, range.end), x(ray, 0), Real(ray.du) * map_.width);
  if (ray.dv != 0) add_lines(y(ray, range.begin), y(ray, range.end), y(ray, 0), Real(ray.dv) * map_.height);
  std::sort(times.begin(), times.end());
  return times;
}

inline BruteForce::Piece BruteForce::piece(const Ray& ray, Real begin, Real end) const {
  const Real middle = (begin + end) / 2;
  const auto i = static_cast<long long>(std::floor(x(ray, middle)));
  const auto j = static_cast<long long>(std::floor(y(ray, middle)));
  const auto c = [&](Real t) { return height(ray, t) - patch(i, j, x(ray, t), y(ray, t)); };
  const Real p = c(begin), q = c(middle), r = c(end);
  return {begin, end, p, -3 * p + 4 * q - r, 2 * (p - 2 * q + r)};
}

/// By bisection up to the lowest point; negative when there is none.
inline Real BruteForce::first_root(const Piece& c) {
  if (c.c0 <= 0) return 0;
  const Real turn = c.turn();
  Real high = c.c2 > 0 && turn > 0 && turn < 1 ? turn : 1;
  if (c.at(high) > 0) return -1;
  Real low = 0;
  for (int i = 0; i < 80; ++i) {
    const Real middle = (low + high) / 2;
    (c.at(middle) > 0 ? low : high) = middle;
  }
  return high;
}

inline bool BruteForce::stays_near_after(const std::vector<Piece>& pieces, std::size_t k, Real s, Real depth,
                                         HitStatus at_end) {
  for (; k < pieces.size(); ++k, s = 0) {
    constexpr int samples = 512;  // the penetration's path, sampled: the turning point is among them
    std::vector<Real> places = {pieces[k].turn()};
    for (int i = 1; i <= samples; ++i) places.push_back(s + (1 - s) * i / samples);
    std::sort(places.begin(), places.end());
    for (const Real place : places) {
      if (place <= s || place > 1) continue;
      if (pieces[k].at(place) <= -depth) return false;
      if (pieces[k].at(place) > 1e-17L) return true;
    }
  }
  return at_end != HitStatus::hit;
}

inline BruteForceHit BruteForce::trace(const Ray& ray, Real ambiguity) const {
  const Range range = range_of(ray);
  if (range.empty) return {range.at_end, 0, false};
  const std::vector<Real> times = crossings(ray, range);
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] > times[i - 1] || times.size() == 2) pieces.push_back(piece(ray, times[i - 1], times[i]));
  BruteForceHit hit{range.at_end, range.end, false};
  Real nearest = HUGE_VALL;  // the lowest clearance so far
  const auto pass = [&](Real c) {
    if (nearest <= ambiguity && c >= nearest) hit.ambiguous = true;
    nearest = std::min(nearest, c);
  };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& c = pieces[k];
    Real s = first_root(c);
    const bool floor = k + 1 == pieces.size() && range.at_end == HitStatus::hit;
    if (s < 0 && floor) s = 1;
    if (s != 0 && k == 0) pass(c.c0);
    if (c.turn() > 0 && c.turn() < (s < 0 ? 1 : s)) pass(c.at(c.turn()));
    if (s < 0) {
      pass(c.at(1));
      continue;
    }
    hit.t = c.begin + s * (c.end - c.begin);
    hit.status = hit.t == 0 && c.c0 < 0 ? HitStatus::inside : HitStatus::hit;
    const bool deep = c.at(s) <= -ambiguity;
    hit.ambiguous = hit.ambiguous || (!deep && stays_near_after(pieces, k, s, ambiguity, range.at_end));
    return hit;
  }
  hit.ambiguous = hit.ambiguous || nearest <= ambiguity;
  return hit;
}

}  // namespace relievo::test
