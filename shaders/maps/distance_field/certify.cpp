/// No distance is longer than the way from the voxel's centre to the bilinear surface, by the metric of the map.
#include <algorithm>
#include <cmath>

#include "maps/surface_search.hpp"

namespace relievo::certifiers {

namespace {

/// The distance from a point to what lies below a bilinear patch, by branch and bound. Lengths sideways are in texels,
/// heights and distances in units of H.
struct PatchDistance {
  oracle::Corners corners;
  CellPlace place;
  double height = 0;      ///< of the point
  double texel_size = 0;  ///< in units of H
  double shortest = 0;    ///< found so far

  double surface(double s, double t) const {
    return std::lerp(std::lerp(corners.h00, corners.h10, s), std::lerp(corners.h01, corners.h11, s), t);
  }

  double to(double x, double y, double top) const {
    return std::hypot(std::hypot(x, y) * texel_size, std::max(height - top, 0.0));
  }

  /// Narrows `shortest` by the part [s, s + size] × [t, t + size] of the patch. A part is nowhere above its highest
  /// corner, so a box as high bounds it; its corners are points of the surface.
  void search(double s, double t, double size) {
    double highest = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const double a = s + (corner % 2) * size, b = t + (corner / 2) * size, top = surface(a, b);
      highest = std::max(highest, top);
      shortest = std::min(shortest, to(place.x + a, place.y + b, top));
    }
    const double x = std::clamp(0.0, place.x + s, place.x + s + size);
    const double y = std::clamp(0.0, place.y + t, place.y + t + size);
    constexpr double smallest = 1.0 / 256;  // texels: the end of the search wherever the bounds are that near
    if (to(x, y, highest) >= shortest - 1e-9 || size <= smallest) return;
    for (int child = 0; child < 4; ++child) search(s + (child % 2) * size / 2, t + (child / 2) * size / 2, size / 2);
  }
};

/// By how much `stored` is longer than the distance from a point above texel (x, y).
double excess_at(const SurfaceSearch& search, int x, int y, double height, double texel_size, double stored) {
  double shortest = stored;
  const auto matters = [&](double highest, double distance) {
    return std::hypot(distance * texel_size, std::max(height - highest, 0.0)) < shortest;
  };
  search.for_each_cell(x, y, matters, [&](const oracle::Corners& corners, CellPlace place) {
    PatchDistance patch{corners, place, height, texel_size, shortest};
    patch.search(0, 0, 1);
    shortest = patch.shortest;
  });
  return stored - shortest;
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  const Result<double> layers = baked_value(options, "distance_field", "layers");
  if (!layers) return tl::unexpected(layers.error());
  const Result<double> scale = baked_value(options, "distance_field", "scale");
  if (!scale) return tl::unexpected(scale.error());
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.depth = static_cast<int>(*layers);
  if (Status status = expect_shape(map, expected); !status) return status;
  const SurfaceSearch search(height_map);
  const double longest = std::max(map.width, map.height);
  const double texel_size = 1 / (longest * *scale);
  const std::size_t layer_size = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  check_every_texel(height_map, options, certificate, [&](int x, int y, Certificate& part) {
    const std::size_t texel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
    for (int layer = 0; layer < map.depth; ++layer) {
      const double stored = map.texels[texel + static_cast<std::size_t>(layer) * layer_size];
      const double height = (layer + 0.5) / map.depth;
      const double excess = stored >= 0 ? excess_at(search, x, y, height, texel_size, stored) : 1;
      count_check(part, excess, options.tolerance, x, y, 0, layer);
    }
  });
  return {};
}

}  // namespace

extern const Certifier distance_field;
const Certifier distance_field = {"no distance is longer than the way to the surface (H)", check};

}  // namespace relievo::certifiers
