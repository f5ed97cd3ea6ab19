#include "oracle/axis_walk.hpp"

#include <cmath>

namespace relievo::oracle {
namespace {

int first_cell(const LatticeAxis& axis, double whole) {
  if (!axis.periodic) return static_cast<int>(std::clamp(whole + 1, 0.0, static_cast<double>(axis.cells - 1)));
  const double cell = std::fmod(whole, static_cast<double>(axis.cells));
  return static_cast<int>(cell < 0 ? cell + axis.cells : cell);
}

}  // namespace

AxisWalk make_axis_walk(const LatticeAxis& axis, TexelCoordinate start, double direction) {
  AxisWalk walk;
  walk.cells = axis.cells;
  walk.first_cell = first_cell(axis, start.whole);
  const double lower_line = walk.first_cell - 1;
  walk.local_start = axis.periodic ? start.fraction : (start.whole - lower_line) + start.fraction;
  if (direction == 0) return walk;
  walk.step = direction > 0 ? 1 : -1;
  walk.direction = direction;
  walk.inverse = 1 / std::abs(direction);
  walk.distance = direction > 0 ? 1 - walk.local_start : walk.local_start;
  const int lines = direction > 0 ? axis.cells - 1 - walk.first_cell : walk.first_cell;
  walk.lines = axis.periodic ? std::numeric_limits<double>::infinity() : lines;
  return walk;
}

}  // namespace relievo::oracle
