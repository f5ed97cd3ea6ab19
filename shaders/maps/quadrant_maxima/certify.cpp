/// Every window's value bounds the corners of its cells from above, and every corner is bounded by its own; over a cell
/// the bilinear surface is nowhere above its corners. The windows' maxima are taken anew here, by sliding maxima along rows and
/// then columns of the endless surface.
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

double highest_corner(const HeightMap& map, int x, int y) {
  auto corner = [&](int i, int j) {
    return map.at(wrap_texel(i, map.width, map.address), wrap_texel(j, map.height, map.address));
  };
  return std::max({corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)});
}

/// Greatest of values[i … i + count − 1] for every i that has so many after it.
std::vector<double> sliding_maximum(const std::vector<double>& values, std::size_t count) {
  std::vector<double> result;
  std::deque<std::size_t> candidates;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (!candidates.empty() && values[candidates.back()] <= values[i]) candidates.pop_back();
    candidates.push_back(i);
    if (candidates.front() + count <= i) candidates.pop_front();
    if (i + 1 >= count) result.push_back(values[candidates.front()]);
  }
  return result;
}

/// For every cell, over the windows of `count` cells that begin there, or end there along an axis that is headed for
/// backwards.
std::vector<double> window_maxima(const HeightMap& map, int count, bool before_x, bool before_y) {
  const int first_x = before_x ? 1 - count : 0, first_y = before_y ? 1 - count : 0;
  const int rows = map.height + count - 1, columns = map.width + count - 1;
  std::vector<std::vector<double>> along_rows;
  for (int y = 0; y < rows; ++y) {
    std::vector<double> row(static_cast<std::size_t>(columns));
    for (int x = 0; x < columns; ++x) row[static_cast<std::size_t>(x)] = highest_corner(map, first_x + x, first_y + y);
    along_rows.push_back(sliding_maximum(row, static_cast<std::size_t>(count)));
  }
  std::vector<double> maxima(map.texels.size());
  for (std::size_t x = 0; x < static_cast<std::size_t>(map.width); ++x) {
    std::vector<double> column;
    for (const std::vector<double>& row : along_rows) column.push_back(row[x]);
    column = sliding_maximum(column, static_cast<std::size_t>(count));
    for (std::size_t y = 0; y < column.size(); ++y) maxima[y * static_cast<std::size_t>(map.width) + x] = column[y];
  }
  return maxima;
}

/// What bake.glsl may round away, which the technique allows for.
constexpr double rounding = 1.0 / (1 << 22);

/// The bytes of a channel as heights.
struct Bytes {
  double window, corner;
};
Bytes unpack(float channel) {
  const auto both = static_cast<unsigned>(std::lround(static_cast<double>(channel) * 65535));
  return {(both >> 8) / 255.0, (both & 255U) / 255.0};
}

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.channels = 4;
  expected.depth = 4;
  if (Status status = expect_shape(map, expected); !status) return status;
  auto parameter = [&](const char* name, int fallback) {
    const auto found = options.values.find(name);
    return found == options.values.end() ? fallback : static_cast<int>(found->second);
  };
  const int ratio = parameter("quadrant_maxima.ratio", 3);
  const std::size_t texels = height_map.texels.size();
  for (int layer = 0; layer < 4; ++layer) {
    int width = parameter("quadrant_maxima.first", 2);
    const bool before_x = (layer & 1) != 0, before_y = (layer & 2) != 0;
    for (int channel = 0; channel < 4; ++channel, width *= ratio) {
      const std::vector<double> maxima = window_maxima(height_map, width, before_x, before_y);
      for (std::size_t i = 0; i < texels; ++i) {
        const int x = static_cast<int>(i) % map.width, y = static_cast<int>(i) / map.width;
        const std::size_t index = (static_cast<std::size_t>(layer) * texels + i) * 4 + static_cast<std::size_t>(channel);
        const Bytes bytes = unpack(map.texels[index]);
        count_check(certificate, maxima[i] - bytes.window - rounding, options.tolerance, x, y, 0, layer);
        const double corner =
            height_map.at(wrap_texel(x + (((channel & 1) != 0) != before_x), map.width, map.address),
                          wrap_texel(y + (((channel & 2) != 0) != before_y), map.height, map.address));
        count_check(certificate, corner - bytes.corner - rounding, options.tolerance, x, y, 0, layer);
      }
    }
  }
  return {};
}

}  // namespace

extern const Certifier quadrant_maxima;
const Certifier quadrant_maxima = {
    "no corner of a cell in a window is above the window's value, nor one of the cell above its own, by more than 2^-22 (H)",
    check};

}  // namespace relievo::certifiers
