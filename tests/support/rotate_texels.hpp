/// A fault for certifiers to find: every texel of a map in another's place.
#pragma once

#include <cstddef>
#include <vector>

#include "relievo/maps.hpp"

namespace relievo::test {

/// Moves every value `by` elements towards the front, round the end.
inline void rotate_texels(MapData& map, std::size_t by) {
  const std::vector<float> before = map.texels.floats();
  for (std::size_t i = 0; i < before.size(); ++i) map.texels.set(i, before[(i + by) % before.size()]);
}

}  // namespace relievo::test
