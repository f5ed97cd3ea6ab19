#include "maps/map_layout.hpp"

#include <algorithm>

#include "relievo/image.hpp"

namespace relievo {

namespace {

MapLayout layout_of_layers(const MapData& shape) {
  const int in_column = std::clamp(max_image_extent / shape.height, 1, shape.depth);
  const std::size_t texels = static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height);
  MapLayout layout;
  layout.width = shape.width * ((shape.depth + in_column - 1) / in_column);
  layout.height = shape.height * in_column;
  for (int k = 0; k < shape.depth; ++k) {
    layout.panels.push_back({shape.width * (k / in_column), shape.height * (k % in_column), shape.width, shape.height,
                             texels * static_cast<std::size_t>(k)});
  }
  return layout;
}

MapLayout layout_of_levels(const MapData& shape) {
  MapLayout layout{shape.width, shape.height, {{0, 0, shape.width, shape.height, 0}}};
  int below = 0;
  for (int k = 1; k < shape.levels; ++k) {
    const MapLevel level = map_level(shape, k);
    layout.panels.push_back({shape.width, below, level.width, level.height, level.offset});
    layout.width = std::max(layout.width, shape.width + level.width);
    below += level.height;
  }
  layout.height = std::max(layout.height, below);
  return layout;
}

}  // namespace

MapLayout map_layout(const MapData& shape) {
  return shape.depth > 1 ? layout_of_layers(shape) : layout_of_levels(shape);
}

}  // namespace relievo
