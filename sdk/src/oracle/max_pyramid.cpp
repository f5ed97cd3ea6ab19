#include "oracle/max_pyramid.hpp"

namespace relievo::oracle {

MaxPyramid::MaxPyramid(const Lattice& lattice) {
  levels_.push_back(from_cells(lattice));
  while (levels_.back().max.size() > 1) levels_.push_back(from_finer(levels_.back()));
}

MaxPyramid::Level MaxPyramid::from_cells(const Lattice& lattice) {
  const int cells_x = lattice.x().cells, cells_y = lattice.y().cells;
  Level level;
  for (int y = 0; y < cells_y; y += 2) {
    const int last_line_y = std::min(y + 2, cells_y);
    for (int x = 0; x < cells_x; x += 2) {
      const int last_line_x = std::min(x + 2, cells_x);
      float highest = 0;
      for (int j = y; j <= last_line_y; ++j)
        for (int i = x; i <= last_line_x; ++i) highest = std::max(highest, lattice.at(i, j));
      level.max.push_back(highest);
    }
  }
  level.width = static_cast<std::size_t>((cells_x + 1) / 2);
  level.height = static_cast<std::size_t>((cells_y + 1) / 2);
  return level;
}

MaxPyramid::Level MaxPyramid::from_finer(const Level& finer) {
  Level level{(finer.width + 1) / 2, (finer.height + 1) / 2, {}};
  for (std::size_t y = 0; y < level.height; ++y) {
    const float* row = finer.max.data() + 2 * y * finer.width;
    const float* next = 2 * y + 1 < finer.height ? row + finer.width : row;
    for (std::size_t x = 0; x < level.width; ++x) {
      const std::size_t a = 2 * x, b = std::min(a + 1, finer.width - 1);
      level.max.push_back(std::max(std::max(row[a], row[b]), std::max(next[a], next[b])));
    }
  }
  return level;
}

}  // namespace relievo::oracle
