/// The promise of max_pyramid, wherever its levels are packed.
#include <algorithm>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

struct Nodes {
  int x = 0, y = 0;
};

// The three below are the twins of packing.glsl.
Nodes packed_size(Nodes extent, int level) {
  return {((extent.x - 1) >> level) + 1, ((extent.y - 1) >> level) + 1};
}

Nodes packed_origin(Nodes extent, int level) {
  if (level == 1) return {};
  const bool wide = extent.x >= extent.y;
  const Nodes first = packed_size(extent, 1);
  const bool strip = std::min(extent.x, extent.y) == 1;
  Nodes origin = wide == strip ? Nodes{first.x, 0} : Nodes{0, first.y};
  for (int k = 2; k < level; ++k) {
    const Nodes size = packed_size(extent, k);
    (wide ? origin.x : origin.y) += wide ? size.x : size.y;
  }
  return origin;
}

int packed_top(Nodes extent) {
  int top = 0;
  for (; top < 15; ++top) {
    const Nodes here = packed_size(extent, top), next = packed_size(extent, top + 1);
    const Nodes origin = packed_origin(extent, top + 1);
    if ((here.x == 1 && here.y == 1) || origin.x + next.x > extent.x || origin.y + next.y > extent.y) break;
  }
  return top;
}

double node_value(const MapData& map, Nodes node, int level) {
  const Nodes origin = level == 0 ? Nodes{} : packed_origin({map.width, map.height}, level);
  const int row = (level == 0 ? 0 : map.height) + origin.y + node.y;
  return map.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
                    static_cast<std::size_t>(origin.x + node.x)];
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.depth = 2;
  if (Status status = expect_shape(map, expected); !status) return status;
  const int top = packed_top({height_map.width, height_map.height});
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const double highest = cell_range(height_map, x, y).high;
      for (int level = 0; level <= top; ++level) {
        const Nodes node{x >> level, y >> level};
        count_check(certificate, highest - node_value(map, node, level), options.tolerance, node.x, node.y, level,
                    level > 0);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier pyramid_3d;
const Certifier pyramid_3d = {"no corner of a cell is above the value of a packed node that holds the cell (H)", check};

}  // namespace relievo::certifiers
