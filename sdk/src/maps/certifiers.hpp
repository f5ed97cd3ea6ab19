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

/// One promise checked: broken by `excess` (positive: broken) in the promise's unit.
void count_check(Certificate& certificate, double excess, double tolerance, int x, int y, int level = 0, int layer = 0);

/// Adds what another thread has counted.
void merge(Certificate& into, const Certificate& part);

}  // namespace relievo
