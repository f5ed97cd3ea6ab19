/// Unit normals of the central differences at the texel centres (survey Eq. 9).
#include <algorithm>
#include <cmath>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

/// What single precision may cost: a difference of two heights, three products, a root and a division that Vulkan
/// allows 3 ulp each, of components up to 1.
constexpr double rounding = 2e-6;

struct Vector {
  double x = 0, y = 0, z = 0;
};

double length(const Vector& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

Vector expected_normal(const HeightMap& map, double scale, int x, int y) {
  const auto at = [&](int i, int j) {
    return static_cast<double>(map.at(wrap_texel(i, map.width, map.address), wrap_texel(j, map.height, map.address)));
  };
  const double along_u = 0.5 * (at(x + 1, y) - at(x - 1, y)) * map.width;
  const double along_v = 0.5 * (at(x, y + 1) - at(x, y - 1)) * map.height;
  const Vector normal{-scale * along_u, -scale * along_v, 1};
  const double size = length(normal);
  return {normal.x / size, normal.y / size, normal.z / size};
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.channels = 3;
  if (Status status = expect_shape(map, expected); !status) return status;
  const Result<double> scale = baked_value(options, "normal", "scale");
  if (!scale) return tl::unexpected(scale.error());
  const double baked_scale = static_cast<float>(*scale);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t texel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      const Vector normal{map.texels[3 * texel], map.texels[3 * texel + 1], map.texels[3 * texel + 2]};
      const Vector wanted = expected_normal(height_map, baked_scale, x, y);
      const double apart = length({normal.x - wanted.x, normal.y - wanted.y, normal.z - wanted.z});
      const double stretched = std::abs(length(normal) - 1);
      count_check(certificate, std::max(apart, stretched) - rounding, options.tolerance, x, y);
    }
  }
  return {};
}

}  // namespace

extern const Certifier normal;
const Certifier normal = {"every normal is within 2e-6 of unit length and of the normal by central differences", check};

}  // namespace relievo::certifiers
