/// Every texel's rises are no less than those of the nodes that hold it.
#include <array>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

/// As the shader reads it: beyond the edge of a mirrored map what rises falls again.
float outward_height(const HeightMap& map, int x, int y) {
  const bool is_beyond = x < 0 || y < 0 || x >= map.width || y >= map.height;
  if (map.address == AddressMode::mirror && is_beyond) return 0;
  return map.at(wrap_texel(x, map.width, map.address), wrap_texel(y, map.height, map.address));
}

/// In float, in which the difference of two texels is taken.
std::array<float, 4> rises_at(const HeightMap& map, int x, int y) {
  const float own = map.at(x, y);
  const auto to = [&](int next_x, int next_y) { return outward_height(map, next_x, next_y) - own; };
  return {to(x + 1, y), to(x - 1, y), to(x, y + 1), to(x, y - 1)};
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  if (Status status = expect_pyramid(map, height_map, MapLevels::coarse_pyramid, 4); !status) return status;
  for (int y = 0; y < height_map.height; ++y) {
    for (int x = 0; x < height_map.width; ++x) {
      const std::array<float, 4> rises = rises_at(height_map, x, y);
      for (int level = 0; level < map.levels; ++level) {
        const int node_x = x >> (level + 2), node_y = y >> (level + 2);
        const std::size_t first = first_value(map, node_x, node_y, level);
        for (std::size_t k = 0; k < rises.size(); ++k) {
          const double excess = static_cast<double>(map.texels[first + k]) - static_cast<double>(rises[k]);
          count_check(certificate, excess, options.tolerance, node_x, node_y, level);
        }
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier rise_pyramid;
const Certifier rise_pyramid = {"no texel of a node rises less to the next one along +u, -u, +v, -v than the node says (H)",
                                check};

}  // namespace relievo::certifiers
