#include "maps/certify_cones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "maps/certifiers.hpp"

namespace relievo::certifiers {

namespace {

/// Of maps with more cells than this, every k-th is checked.
constexpr std::size_t sampled_cells = 3000;

/// The greatest height in every cell of the endless surface.
class CellMaxima {
 public:
  explicit CellMaxima(const HeightMap& map) : map_(map), columns_(map.width + 2 * margin(map.width)) {
    const int rows = map.height + 2 * margin(map.height);
    values_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows));
    for (int y = -margin(map.height); y < rows - margin(map.height); ++y)
      for (int x = -margin(map.width); x < columns_ - margin(map.width); ++x) values_.push_back(highest_corner(x, y));
    greatest_ = *std::max_element(values_.begin(), values_.end());
  }

  /// For cells of the map and those up to margin() beyond it.
  double at(int x, int y) const {
    return values_[static_cast<std::size_t>(y + margin(map_.height)) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(x + margin(map_.width))];
  }
  double greatest() const { return greatest_; }

  /// Beyond two copies of the map there is nothing that is not nearer as well.
  static int margin(int extent) { return std::min(2 * extent + 2, 1024); }

 private:
  double highest_corner(int x, int y) const {
    auto corner = [&](int i, int j) {
      return map_.at(wrap_texel(i, map_.width, map_.address), wrap_texel(j, map_.height, map_.address));
    };
    return std::max({corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)});
  }

  const HeightMap& map_;
  int columns_ = 0;
  std::vector<double> values_;
  double greatest_ = 0;
};

/// Directions (x, y) with x, y of the signs of `heading` and slopes of the lesser axis to the greater in [low, high].
struct Sector {
  bool everywhere = false, quadrant = false, steep = false;
  int heading_x = 1, heading_y = 1;
  double low = 0, high = 1;

  /// Does a ray of the sector that starts in cell (0, 0) enter the inside of cell (i, j)?
  bool enters(int i, int j) const {
    if (everywhere) return true;
    i *= heading_x;
    j *= heading_y;
    if (i < 0 || j < 0) return false;
    if (quadrant) return true;
    if (steep) std::swap(i, j);
    return j - 1 < high * (i + 1) && j + 1 > low * std::max(i - 1, 0);
  }
};

Sector sector_of(int layer, int sectors) {
  Sector sector;
  sector.everywhere = sectors == 0;
  sector.quadrant = sectors < 8;
  sector.heading_x = (layer & 1) != 0 ? -1 : 1;
  sector.heading_y = (layer & 2) != 0 ? -1 : 1;
  if (sector.quadrant) return sector;
  const int cuts = sectors / 8, slice = layer / 4 % (2 * cuts);
  sector.steep = slice >= cuts;
  sector.low = static_cast<double>(slice % cuts) / cuts;
  sector.high = static_cast<double>(slice % cuts + 1) / cuts;
  return sector;
}

struct Cone {
  double highest = 0, apex = 0, slope = 0;
};

/// By how much the cell that pokes out most does so; negative if none does.
double worst_excess(const CellMaxima& maxima, const Cone& cone, const Sector& sector, int x, int y, int reach_x,
                    int reach_y) {
  double worst = -std::numeric_limits<double>::infinity();
  for (int j = -reach_y; j <= reach_y; ++j) {
    for (int i = -reach_x; i <= reach_x; ++i) {
      const double distance = std::max({std::abs(i) - 1, std::abs(j) - 1, 0});
      const double excess = maxima.at(x + i, y + j) - (cone.apex + cone.slope * distance);
      if (excess > worst && sector.enters(i, j)) worst = excess;
    }
  }
  return std::max(worst, maxima.at(x, y) - cone.highest);
}

/// No further than anything can be above the cone.
int useful_reach(const CellMaxima& maxima, const Cone& cone, int reach, int extent) {
  reach = std::min({reach + 1, CellMaxima::margin(extent)});
  const double highest = std::max(maxima.greatest() - cone.apex, 0.0);
  if (highest < cone.slope * reach) reach = std::min(reach, static_cast<int>(highest / cone.slope) + 2);
  return reach;
}

bool is_at_border(const HeightMap& map, int x, int y) {
  return map.address != AddressMode::repeat && (x == 0 || y == 0 || x == map.width - 1 || y == map.height - 1);
}

}  // namespace

Status check_cones(const HeightMap& height_map, const MapData& map, bool by_sector, const CertifyOptions& options,
                   Certificate& certificate) {
  const Result<double> farthest = baked_value(options, map.name, "reach");
  if (!farthest) return tl::unexpected(farthest.error());
  const Result<double> layers = by_sector ? baked_value(options, map.name, "sectors") : Result<double>(0.0);
  if (!layers) return tl::unexpected(layers.error());
  const int reach = static_cast<int>(*farthest), sectors = static_cast<int>(*layers);
  MapData expected;
  expected.width = height_map.width;
  expected.height = height_map.height;
  expected.channels = 3;
  expected.depth = std::max(sectors, 1);
  if (Status status = expect_shape(map, expected); !status) return status;
  const CellMaxima maxima(height_map);
  const std::size_t cells = height_map.texels.size(), stride = (cells + sampled_cells - 1) / sampled_cells;
  for (int layer = 0; layer < map.depth; ++layer) {
    for (std::size_t i = 0; i < cells; i += stride) {
      const std::size_t texel = 3 * (static_cast<std::size_t>(layer) * cells + i);
      const double root = map.texels[texel + 2];
      const Cone cone = {map.texels[texel], map.texels[texel + 1], root * root};
      const int x = static_cast<int>(i) % map.width, y = static_cast<int>(i) / map.width;
      Sector sector = sector_of(layer, sectors);
      // These stand for the cells beyond the border too, which see their sector from elsewhere.
      sector.quadrant = sector.quadrant || is_at_border(height_map, x, y);
      const double worst = worst_excess(maxima, cone, sector, x, y, useful_reach(maxima, cone, reach, height_map.width),
                                        useful_reach(maxima, cone, reach, height_map.height));
      count_check(certificate, worst, options.tolerance, x, y, 0, layer);
    }
  }
  return {};
}

}  // namespace relievo::certifiers
