/// Every texel holds exactly the heights at its cell's corners.
#include <array>
#include <cmath>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.channels = 4;
  if (Status status = expect_shape(map, expected); !status) return status;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      for (int corner = 0; corner < 4; ++corner) {
        const int i = wrap_texel(x + corner % 2, map.width, map.address);
        const int j = wrap_texel(y + corner / 2, map.height, map.address);
        const std::size_t index =
            4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)) +
            static_cast<std::size_t>(corner);
        const double off = std::abs(static_cast<double>(map.texels[index]) - static_cast<double>(height_map.at(i, j)));
        count_check(certificate, off, options.tolerance, x, y);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier cell_corners;
const Certifier cell_corners = {"every corner is the height map's texel (H)", check};

}  // namespace relievo::certifiers
