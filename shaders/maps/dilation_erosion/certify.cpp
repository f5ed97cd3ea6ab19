/// Every cell's two values bound the surface over its neighbourhood, through the borders of the map too: that of cell
/// -1 as well, which reads cell 0.
#include <algorithm>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

void widen(HeightRange& range, const HeightRange& other) {
  range.low = std::min(range.low, other.low);
  range.high = std::max(range.high, other.high);
}

/// Over the cells [-radius, extent + radius) of one row, the extremes of the 2·radius + 1 cells around.
std::vector<HeightRange> row_ranges(const HeightMap& height_map, int y, int radius) {
  std::vector<HeightRange> cells, ranges;
  for (int x = -radius; x < height_map.width + radius; ++x) cells.push_back(cell_range(height_map, x, y));
  for (int x = 0; x < height_map.width; ++x) {
    HeightRange range = cells[static_cast<std::size_t>(x)];
    for (int i = 1; i <= 2 * radius; ++i) widen(range, cells[static_cast<std::size_t>(x + i)]);
    ranges.push_back(range);
  }
  return ranges;
}

void check_row(const std::vector<std::vector<HeightRange>>& rows, int radius, int y, const MapData& map,
               double tolerance, Certificate& certificate) {
  for (int x = 0; x < map.width; ++x) {
    HeightRange range = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
    for (int j = 1; j <= 2 * radius; ++j)
      widen(range, rows[static_cast<std::size_t>(y + j)][static_cast<std::size_t>(x)]);
    const std::size_t texel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
    const double low = map.texels[2 * texel], high = map.texels[2 * texel + 1];
    count_check(certificate, std::max(low - range.low, range.high - high), tolerance, x, y);
  }
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.channels = 2;
  if (Status status = expect_shape(map, expected); !status) return status;
  const Result<double> given = baked_value(options, "dilation_erosion", "radius");
  if (!given) return tl::unexpected(given.error());
  const int radius = static_cast<int>(*given);
  std::vector<std::vector<HeightRange>> rows;
  for (int y = -radius; y < map.height + radius; ++y) rows.push_back(row_ranges(height_map, y, radius));
  for (int y = 0; y < map.height; ++y) check_row(rows, radius, y, map, options.tolerance, certificate);
  return {};
}

}  // namespace

extern const Certifier dilation_erosion;
const Certifier dilation_erosion = {
    "no corner of the cells up to `radius` away is outside the two values of a cell (H)", check};

}  // namespace relievo::certifiers
