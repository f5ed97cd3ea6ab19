/// Every node bounds the corners of its cells from above; over a cell the bilinear surface is nowhere above its
/// corners.
#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  if (Status status = expect_pyramid(map, height_map, MapLevels::pyramid, 1); !status) return status;
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const double highest = cell_range(height_map, x, y).high;
      for (int level = 0; level < map.levels; ++level) {
        const int node_x = x >> level, node_y = y >> level;
        const double node = map.texels[first_value(map, node_x, node_y, level)];
        count_check(certificate, highest - node, options.tolerance, node_x, node_y, level);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier max_pyramid;
const Certifier max_pyramid = {"no corner of a cell is above the value of a node that holds the cell (H)", check};

}  // namespace relievo::certifiers
