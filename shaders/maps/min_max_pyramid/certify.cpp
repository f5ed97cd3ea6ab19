/// Every node bounds the corners of its cells from both sides; over a cell the bilinear surface is nowhere beyond its
/// corners.
#include <algorithm>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  if (Status status = expect_pyramid(map, height_map, MapLevels::pyramid, 2); !status) return status;
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const HeightRange range = cell_range(height_map, x, y);
      for (int level = 0; level < map.levels; ++level) {
        const int node_x = x >> level, node_y = y >> level;
        const std::size_t node = first_value(map, node_x, node_y, level);
        const double low = map.texels[node], high = map.texels[node + 1];
        count_check(certificate, std::max(low - range.low, range.high - high), options.tolerance, node_x, node_y,
                    level);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier min_max_pyramid;
const Certifier min_max_pyramid = {"no corner of a cell is outside the values of a node that holds the cell (H)",
                                   check};

}  // namespace relievo::certifiers
