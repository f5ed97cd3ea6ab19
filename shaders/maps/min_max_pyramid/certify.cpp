/// Every node bounds the corners of its cells from both sides; over a cell the bilinear surface is nowhere beyond its
/// corners.
#include <algorithm>
#include <bit>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = static_cast<int>(std::bit_ceil(static_cast<unsigned>(height_map.width)));
  expected.height = static_cast<int>(std::bit_ceil(static_cast<unsigned>(height_map.height)));
  expected.levels = std::bit_width(static_cast<unsigned>(std::max(expected.width, expected.height)));
  expected.channels = 2;
  if (Status status = expect_shape(map, expected); !status) return status;
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const HeightRange range = cell_range(height_map, x, y);
      for (int level = 0; level < map.levels; ++level) {
        const MapLevel shape = map_level(map, level);
        const int node_x = x >> level, node_y = y >> level;
        const std::size_t node = shape.offset +
                                 static_cast<std::size_t>(node_y) * static_cast<std::size_t>(shape.width) +
                                 static_cast<std::size_t>(node_x);
        const double low = map.texels[2 * node], high = map.texels[2 * node + 1];
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
