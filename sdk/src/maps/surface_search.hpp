/// The cells of the bilinear surface around a point, found through a maximum pyramid: for certifiers of cones and
/// distances.
#pragma once

#include <mutex>
#include <vector>

#include "compile/parallel.hpp"
#include "maps/certifiers.hpp"
#include "oracle/max_pyramid.hpp"

namespace relievo {

/// A cell's place relative to the point searched from, in texels: [x, x + 1] × [y, y + 1].
struct CellPlace {
  double x = 0, y = 0;
};

class SurfaceSearch {
 public:
  explicit SurfaceSearch(const HeightMap& map) : lattice_(map), pyramid_(lattice_) {}

  /// Calls visit(corners, place) for every cell, and its nearest images, where matters(highest, distance) holds:
  /// `highest` is the maximum of the cell, or of a block that holds it, `distance` from the point in texels. The point
  /// is in texel coordinates, 0 to extent − 1. Images of images, and the extended edge of a clamped map, are left out:
  /// they are as high and farther away.
  template <class Matters, class Visit>
  void for_each_cell(double x, double y, const Matters& matters, const Visit& visit) const {
    const auto images = [](const oracle::LatticeAxis& axis) { return axis.periodic ? 1 : 0; };
    for (int image_y = -images(lattice_.y()); image_y <= images(lattice_.y()); ++image_y) {
      for (int image_x = -images(lattice_.x()); image_x <= images(lattice_.x()); ++image_x) {
        const CellPlace origin = {first_line(lattice_.x()) + image_x * lattice_.x().cells - x,
                                  first_line(lattice_.y()) + image_y * lattice_.y().cells - y};
        descend(pyramid_.top_level(), 0, 0, origin, matters, visit);
      }
    }
  }

 private:
  static double first_line(const oracle::LatticeAxis& axis) { return axis.periodic ? 0 : -1; }

  static double gap(double first, double last) { return std::max({first, -last, 0.0}); }

  template <class Matters, class Visit>
  void descend(int level, int cell_x, int cell_y, CellPlace origin, const Matters& matters, const Visit& visit) const {
    const int cells_x = lattice_.x().cells, cells_y = lattice_.y().cells;
    if (cell_x >= cells_x || cell_y >= cells_y) return;
    const CellPlace place = {origin.x + cell_x, origin.y + cell_y};
    const double size_x = std::min(1 << level, cells_x - cell_x), size_y = std::min(1 << level, cells_y - cell_y);
    const double distance = std::hypot(gap(place.x, place.x + size_x), gap(place.y, place.y + size_y));
    const double highest =
        level > 0 ? pyramid_.max_over_block(level, cell_x, cell_y) : lattice_.corners(cell_x, cell_y).max();
    if (!matters(highest, distance)) return;
    if (level == 0) return visit(lattice_.corners(cell_x, cell_y), place);
    const int half = 1 << (level - 1);
    for (int child = 0; child < 4; ++child)
      descend(level - 1, cell_x + (child % 2) * half, cell_y + (child / 2) * half, origin, matters, visit);
  }

  oracle::Lattice lattice_;
  oracle::MaxPyramid pyramid_;
};

/// Calls check(x, y, certificate) for every texel, on many threads; what they count is added up in row order.
template <class Check>
void check_every_texel(const HeightMap& map, const CertifyOptions& options, Certificate& certificate,
                       const Check& check) {
  std::vector<Certificate> rows(static_cast<std::size_t>(map.height));
  run_parallel(rows.size(), options.threads, [&](std::size_t y) {
    for (int x = 0; x < map.width; ++x) check(x, static_cast<int>(y), rows[y]);
  });
  for (const Certificate& row : rows) merge(certificate, row);
}

}  // namespace relievo
