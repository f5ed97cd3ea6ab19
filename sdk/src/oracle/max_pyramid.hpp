/// Conservative maxima over blocks of cells, so that a walk passes over what lies below the ray.
#pragma once

#include <cstddef>
#include <vector>

#include "oracle/lattice.hpp"

namespace relievo::oracle {

/// Level k ≥ 1 has one maximum for each block of 2^k × 2^k cells, corners included; blocks at the far edges are cut off
/// by the lattice, so any size will do. The last level is a single block.
class MaxPyramid {
 public:
  explicit MaxPyramid(const Lattice& lattice);

  int top_level() const { return static_cast<int>(levels_.size()); }
  /// Maximum of the block that holds a cell; 1 ≤ level ≤ top_level().
  double max_over_block(int level, int cell_x, int cell_y) const {
    const Level& l = levels_[static_cast<std::size_t>(level - 1)];
    return l.max[static_cast<std::size_t>(cell_y >> level) * l.width + static_cast<std::size_t>(cell_x >> level)];
  }

 private:
  struct Level {
    std::size_t width = 0, height = 0;
    std::vector<float> max;
  };
  static Level from_cells(const Lattice& lattice);
  static Level from_finer(const Level& finer);

  std::vector<Level> levels_;
};

}  // namespace relievo::oracle
