/// The cells of a bilinear surface, indexed alike for every address mode.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "relievo/height_map.hpp"

namespace relievo::oracle {

/// One axis: cell c lies between lattice lines c and c+1. With repeat and mirror the cells form one period and line c
/// is at texel coordinate c. With clamp and clip line c is at coordinate c−1, and the first and last cell, in which the
/// height is constant along this axis, extend to infinity: no ray crosses more than extent+1 cells.
struct LatticeAxis {
  int extent = 1;  ///< texels
  int cells = 1;   ///< repeat: extent; mirror: 2·extent; clamp, clip: extent + 1
  bool periodic = true;
  std::vector<std::size_t> offset;  ///< cells + 1 entries: a line's texel index times the axis's stride
};

/// Heights of a cell's corners; the first digit counts along x.
struct Corners {
  double h00 = 0, h10 = 0, h01 = 0, h11 = 0;
  double max() const { return std::max(std::max(h00, h10), std::max(h01, h11)); }
};

class Lattice {
 public:
  /// Copies the map. Texels outside [0,1], NaN and missing ones, which the contract excludes, are brought into [0,1].
  explicit Lattice(const HeightMap& map);

  const LatticeAxis& x() const { return x_; }
  const LatticeAxis& y() const { return y_; }
  AddressMode address() const { return address_; }

  float at(int line_x, int line_y) const {
    return texels_[x_.offset[static_cast<std::size_t>(line_x)] + y_.offset[static_cast<std::size_t>(line_y)]];
  }
  Corners corners(int cell_x, int cell_y) const {
    return {at(cell_x, cell_y), at(cell_x + 1, cell_y), at(cell_x, cell_y + 1), at(cell_x + 1, cell_y + 1)};
  }

 private:
  AddressMode address_;
  LatticeAxis x_, y_;
  std::vector<float> texels_;
};

}  // namespace relievo::oracle
