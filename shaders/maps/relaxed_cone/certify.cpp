/// No point where a level ray leaves the bilinear surface lies within the relaxed cone on a texel's centre. The map
/// looks at texel centres only, and a ridge between them may still be crossed, so violations are expected.
#include <algorithm>
#include <cmath>

#include "maps/surface_search.hpp"

namespace relievo::certifiers {

namespace {

/// How far the surface of one cell, where it falls away from the origin, rises above the cone z = own + slope ·
/// distance. Sampled at samples² points: a fall of less than a fourth of a texel may be missed, never invented.
struct FallingPart {
  oracle::Corners corners;
  CellPlace place;
  double own = 0, slope = 0;
  double fall = 0;  ///< a ray from the lid leaves where the surface falls by (1 − h) · fall on the way to it, at least

  bool rises_everywhere() const {
    const auto along = [](double first, double middle_sign, double second) {
      return middle_sign >= 0 ? std::min(first, second) >= 0 : std::max(first, second) <= 0;
    };
    const bool in_quadrant = (place.x >= 0 || place.x <= -1) && (place.y >= 0 || place.y <= -1);
    return in_quadrant && along(corners.h10 - corners.h00, place.x, corners.h11 - corners.h01) &&
           along(corners.h01 - corners.h00, place.y, corners.h11 - corners.h10);
  }

  double excess() const {
    constexpr int samples = 4;
    double worst = 0;
    if (rises_everywhere()) return worst;
    for (int i = 0; i < samples * samples; ++i) {
      const double s = (i % samples + 0.5) / samples, t = (i / samples + 0.5) / samples;
      const double x = place.x + s, y = place.y + t;
      const double along_u = std::lerp(corners.h10 - corners.h00, corners.h11 - corners.h01, t);
      const double along_v = std::lerp(corners.h01 - corners.h00, corners.h11 - corners.h10, s);
      const double height =
          std::lerp(std::lerp(corners.h00, corners.h10, s), std::lerp(corners.h01, corners.h11, s), t);
      const bool leaves = along_u * x + along_v * y < -fall * (1 - height);
      if (leaves) worst = std::max(worst, height - own - slope * std::hypot(x, y));
    }
    return worst;
  }
};

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  if (Status status = expect_shape(map, expected); !status) return status;
  const SurfaceSearch search(height_map);
  const double longest = std::max(map.width, map.height);
  const Result<double> fall = baked_value(options, "relaxed_cone", "from_lid");
  if (!fall) return tl::unexpected(fall.error());
  check_every_texel(height_map, options, certificate, [&](int x, int y, Certificate& part) {
    const double own = height_map.at(x, y);
    const double encoded =
        map.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)];
    if (!(encoded > 0)) return count_check(part, encoded == 0 ? 0 : 1, options.tolerance, x, y);
    const double slope = 1 / (encoded * encoded * longest);
    double excess = 0;
    search.for_each_cell(
        x, y, [&](double highest, double distance) { return highest - own - slope * distance > excess; },
        [&](const oracle::Corners& corners, CellPlace place) {
          excess = std::max(excess, FallingPart{corners, place, own, slope, *fall}.excess());
        });
    count_check(part, excess, options.tolerance, x, y);
  });
  return {};
}

}  // namespace

extern const Certifier relaxed_cone;
const Certifier relaxed_cone = {"no ray leaves the surface within the relaxed cone on a texel's centre (H)", check,
                                false};

}  // namespace relievo::certifiers
