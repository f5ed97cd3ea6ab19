#include "oracle/clearance.hpp"

#include <cmath>

namespace relievo::oracle {
namespace {

/// c1² − 4·c0·c2 with an error far below its own cancellation (Kahan, "On the Cost of Floating-Point Computation
/// Without Extra-Precise Arithmetic", 2004): an exactly tangent ray keeps its exact zero.
double discriminant(const Clearance& c) {
  const double p = c.c1 * c.c1, q = 4 * c.c0 * c.c2;
  const double d = p - q;
  if (3 * std::abs(d) >= p + std::abs(q)) return d;
  return d + (std::fma(c.c1, c.c1, -p) - std::fma(4 * c.c0, c.c2, -q));
}

/// Smallest positive root for c0 > 0 and a discriminant ≥ 0. Neither form subtracts nearly equal numbers; c2 = 0 needs
/// no branch in the first, and the second is only reached with c2 < 0.
double smallest_positive_root(const Clearance& c, double disc) {
  const double r = std::sqrt(std::max(disc, 0.0));
  if (c.c1 < 0) return 2 * c.c0 / (r - c.c1);
  return -(c.c1 + r) / (2 * c.c2);
}

}  // namespace

std::optional<double> Clearance::first_root(double length, double at_end) const {
  if (c0 <= 0) return 0.0;
  // The signs at the ends decide where there is one crossing; rounding in the root can then only move it within the
  // cell.
  if (at_end <= 0) {
    const double s = smallest_positive_root(*this, discriminant(*this));
    return s >= 0 && s <= length ? s : length;
  }
  const bool dips_inside = c1 < 0 && c2 > 0 && -c1 < 2 * c2 * length;
  if (!dips_inside) return std::nullopt;
  const double disc = discriminant(*this);
  if (disc < 0) return std::nullopt;
  return std::min(smallest_positive_root(*this, disc), length);
}

bool Clearance::turns_away_within(double distance, double length) const {
  if (length <= 0) return false;
  const bool rises_at_once = c1 > 0 || (c1 == 0 && c2 >= 0);
  if (rises_at_once) return c0 <= distance;
  const bool dips_inside = c2 > 0 && -c1 < 2 * c2 * length;
  return dips_inside && c0 - c1 * c1 / (4 * c2) <= distance;
}

Penetration penetration(Clearance c, double length, double depth) {
  c.c0 = std::min(c.c0, 0.0);  // continuity: a positive start is rounding
  if (c.c0 <= -depth) return Penetration::deepens;
  const double vertex = c.c2 != 0 ? -c.c1 / (2 * c.c2) : -1;
  const bool turns = vertex > 0 && vertex < length;
  const double turned = turns ? c.at(vertex) : c.c0;
  const double end = c.at(length);
  if (turned <= -depth) return Penetration::deepens;
  if (turned > 0) return Penetration::comes_out;
  if (end <= -depth) return Penetration::deepens;
  return end > 0 ? Penetration::comes_out : Penetration::undecided;
}

}  // namespace relievo::oracle
