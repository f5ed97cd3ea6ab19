/// Every node bounds the corners of its cells from above; over a cell the bilinear surface is nowhere above its
/// corners.
#include <algorithm>
#include <bit>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

double highest_corner(const HeightMap& map, int x, int y) {
  const int x1 = wrap_texel(x + 1, map.width, map.address), y1 = wrap_texel(y + 1, map.height, map.address);
  return std::max({map.at(x, y), map.at(x1, y), map.at(x, y1), map.at(x1, y1)});
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = static_cast<int>(std::bit_ceil(static_cast<unsigned>(height_map.width)));
  expected.height = static_cast<int>(std::bit_ceil(static_cast<unsigned>(height_map.height)));
  expected.levels = std::bit_width(static_cast<unsigned>(std::max(expected.width, expected.height)));
  if (Status status = expect_shape(map, expected); !status) return status;
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const double highest = highest_corner(height_map, x, y);
      for (int level = 0; level < map.levels; ++level) {
        const MapLevel shape = map_level(map, level);
        const int node_x = x >> level, node_y = y >> level;
        const std::size_t index = shape.offset +
                                  static_cast<std::size_t>(node_y) * static_cast<std::size_t>(shape.width) +
                                  static_cast<std::size_t>(node_x);
        count_check(certificate, highest - static_cast<double>(map.texels[index]), options.tolerance, node_x, node_y,
                    level);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier max_pyramid;
const Certifier max_pyramid = {"no corner of a cell is above the value of a node that holds the cell (H)", check};

}  // namespace relievo::certifiers
