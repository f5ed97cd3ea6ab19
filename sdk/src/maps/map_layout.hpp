/// Where the levels and layers of a map lie in one image.
#pragma once

#include <vector>

#include "relievo/maps.hpp"

namespace relievo {

/// One level or layer: its top left pixel, its extent, and where its texels begin in MapData::texels (in texels).
struct MapPanel {
  int x = 0, y = 0;
  int width = 0, height = 0;
  std::size_t offset = 0;
};

/// Layers stand one below the other, in as many columns from left to right as the largest image extent asks for. Level
/// 0 stands at the left and the other levels one below the other in a column at its right. What no panel covers is 0.
struct MapLayout {
  int width = 0, height = 0;  ///< pixels; may exceed max_image_extent, which the image writers refuse
  std::vector<MapPanel> panels;
};

MapLayout map_layout(const MapData& shape);

}  // namespace relievo
