/// What certifiers share, and the list of them, which the build makes from the folders of shaders/maps.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "relievo/certify.hpp"

namespace relievo {

namespace certifiers {
/// By map name, sorted.
const std::vector<std::pair<std::string_view, const Certifier*>>& all();
}  // namespace certifiers

/// "certify.shape" unless extent, layers, levels and channels are as expected and every texel is there.
Status expect_shape(const MapData& map, const MapData& expected);

/// The same for the pyramid that such a map of this height map is.
Status expect_pyramid(const MapData& map, const HeightMap& height_map, MapLevels levels, int channels);

/// Index of channel 0 of a texel of a level, for flat maps.
std::size_t first_value(const MapData& map, int x, int y, int level);

/// The value that `map` was baked with: of `options`, else the default of its descriptor.
/// Errors: "certify.parameter" when it is out of its range or, of an integer, not whole.
Result<double> baked_value(const CertifyOptions& options, std::string_view map, std::string_view parameter);

/// Least and greatest height of the bilinear cell (x, y): those of its corners, for a bilinear patch has none beyond.
struct HeightRange {
  double low = 0, high = 0;
};
HeightRange cell_range(const HeightMap& height_map, int x, int y);

/// One promise checked: broken by `excess` (positive: broken) in the promise's unit.
void count_check(Certificate& certificate, double excess, double tolerance, int x, int y, int level = 0, int layer = 0);

/// Adds what another thread has counted.
void merge(Certificate& into, const Certificate& part);

}  // namespace relievo
