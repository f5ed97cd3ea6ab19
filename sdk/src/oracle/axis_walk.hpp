/// When a ray crosses the grid lines of one axis, as a function of how many it has crossed.
#pragma once

#include <algorithm>
#include <limits>

#include "oracle/lattice.hpp"
#include "oracle/segment.hpp"

namespace relievo::oracle {

/// Crossing times come from the line's number alone, never from the previous time plus an increment: errors do not add
/// up over a long walk, and a walk that passes over a block sees the very same times as one that visits each cell.
struct AxisWalk {
  double distance = 0;                ///< texels to the first line ahead
  double lines = 0;                   ///< lines ahead: infinite for a periodic axis, 0 for a ray parallel to the lines
  double direction = 0, inverse = 0;  ///< texels per τ, and τ per texel (absolute)
  double local_start = 0;             ///< texels from the first cell's lower line to the ray's start
  int first_cell = 0, cells = 1;
  int step = 0;  ///< −1, 0, 1

  /// τ of line number n ≥ 0; infinite where there is none.
  double crossing(double n) const {
    return n < lines ? (distance + n) * inverse : std::numeric_limits<double>::infinity();
  }
  /// τ at which the last of n lines was crossed; 0 before the first.
  double entry(double n) const { return n > 0 ? (distance + (n - 1)) * inverse : 0; }
  /// Position in [0,1] across the cell that the ray is in after n lines.
  double local(double n, double tau) const { return std::clamp(local_start - step * n + direction * tau, 0.0, 1.0); }
  /// The cell after `cell`. Only a periodic axis has one beyond the last.
  int next(int cell) const {
    cell += step;
    return cell == cells ? 0 : cell < 0 ? cells - 1 : cell;
  }
  /// Number of the line through which a ray leaves the block of 2^level cells that holds `cell`, n lines being behind.
  double last_line_of_block(int level, int cell, double n) const {
    const int low = (cell >> level) << level;
    if (step < 0) return n + (cell - low);
    return n + (std::min(low + (1 << level), cells) - 1 - cell);
  }
  /// Lines crossed before τ (with `closed`, also at τ), given that between n and `last` are.
  double lines_before(double tau, bool closed, double n, double last) const;
};

AxisWalk make_axis_walk(const LatticeAxis& axis, TexelCoordinate start, double direction);

inline double AxisWalk::lines_before(double tau, bool closed, double n, double last) const {
  const auto is_behind = [&](double line) { return closed ? crossing(line) <= tau : crossing(line) < tau; };
  if (step == 0) return n;
  const double estimate = tau * (direction * step) - distance;
  double m = n;
  if (estimate > n) m = static_cast<double>(static_cast<long long>(std::min(estimate, last)));
  while (m > n && !is_behind(m - 1)) m -= 1;
  while (m < last && is_behind(m)) m += 1;
  return m;
}

}  // namespace relievo::oracle
