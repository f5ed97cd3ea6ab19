/// No point of the bilinear surface lies within the cone on a texel's centre. The classic map knows texel centres only:
/// the edge between two of them may still pass through the cone, so violations are expected.
#include <algorithm>
#include <cmath>

#include "maps/surface_search.hpp"

namespace relievo::certifiers {

namespace {

/// The greatest height above the cone along the row y of a cell: the surface is a straight line there and the cone
/// convex, so the maximum is where their slopes agree, or at an end.
double highest_in_row(const oracle::Corners& c, CellPlace place, double share, double slope) {
  const double left = std::lerp(c.h00, c.h01, share), right = std::lerp(c.h10, c.h11, share);
  const double y = place.y + share, rise = right - left;
  double x = rise > 0 ? place.x + 1 : place.x;
  if (std::abs(rise) < slope) x = std::abs(y) * rise / std::sqrt((slope - rise) * (slope + rise));
  x = std::clamp(x, place.x, place.x + 1);
  return left + rise * (x - place.x) - slope * std::hypot(x, y);
}

/// The greatest height of the surface in a cell above the cone z = slope · distance, to about 1e-9: the best of 9 rows,
/// then golden sections around it.
double highest_in_cell(const oracle::Corners& corners, CellPlace place, double slope) {
  constexpr int rows = 8;
  const auto at = [&](double share) { return highest_in_row(corners, place, share, slope); };
  int best = 0;
  for (int i = 1; i <= rows; ++i)
    if (at(double(i) / rows) > at(double(best) / rows)) best = i;
  double low = std::max(best - 1, 0) / double(rows), high = std::min(best + 1, rows) / double(rows);
  double highest = at(double(best) / rows);
  constexpr double golden = 0.6180339887498949;
  for (int i = 0; i < 24; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    const double at_a = at(a), at_b = at(b);
    highest = std::max({highest, at_a, at_b});
    (at_a > at_b ? high : low) = at_a > at_b ? b : a;
  }
  return highest;
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  if (Status status = expect_shape(map, expected); !status) return status;
  const SurfaceSearch search(height_map);
  const double longest = std::max(map.width, map.height);
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
          excess = std::max(excess, highest_in_cell(corners, place, slope) - own);
        });
    count_check(part, excess, options.tolerance, x, y);
  });
  return {};
}

}  // namespace

extern const Certifier cone;
const Certifier cone = {"no point of the surface is above the cone on a texel's centre (H)", check, false};

}  // namespace relievo::certifiers
