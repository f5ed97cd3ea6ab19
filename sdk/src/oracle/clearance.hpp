/// How far a ray is above the surface within one cell: the quadratic whose first root is the hit.
#pragma once

#include <algorithm>
#include <optional>

#include "oracle/lattice.hpp"

namespace relievo::oracle {

/// H − h along a ray within one cell, as c0 + c1·s + c2·s² with s counted from where the ray enters the cell.
/// Restricted to a line the bilinear height is quadratic: its twist (h00 − h10 − h01 + h11) times dx·dy is the s² term.
struct Clearance {
  double c0 = 0, c1 = 0, c2 = 0;

  double at(double s) const { return c0 + s * (c1 + s * c2); }
  double slope_at(double s) const { return c1 + 2 * c2 * s; }

  /// Smallest s in [0, length] with at(s) ≤ 0. `at_end` is at(length), computed better than by this polynomial.
  std::optional<double> first_root(double length, double at_end) const;
  /// True when the ray comes within `distance` in [0, length] and then does not come closer: a near pass.
  bool turns_away_within(double distance, double length) const;
};

/// The clearance of the height `h` over the point (a, b) of a cell, both in [0,1].
inline double clearance_at(const Corners& k, double a, double b, double h) {
  const double twist = (k.h00 - k.h10) + (k.h11 - k.h01);
  return h - (k.h00 + (k.h10 - k.h00) * a + ((k.h01 - k.h00) + twist * a) * b);
}

/// The clearance along a ray from there in direction (dx, dy, dh).
inline Clearance clearance_in_cell(const Corners& k, double a, double b, double h, double dx, double dy, double dh) {
  const double along_x = k.h10 - k.h00, along_y = k.h01 - k.h00;
  const double twist = (k.h00 - k.h10) + (k.h11 - k.h01);
  return {clearance_at(k, a, b, h), dh - (dx * (along_x + twist * b) + dy * (along_y + twist * a)), -twist * (dx * dy)};
}

/// What a ray does after it has met the surface.
enum class Penetration { deepens, comes_out, undecided };

/// Follows the clearance over [0, length] from a point at or below the surface: does it sink to −depth before it rises
/// above 0?
Penetration penetration(Clearance clearance, double length, double depth);

}  // namespace relievo::oracle
