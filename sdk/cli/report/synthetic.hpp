/// Height maps made by rule: shapes that tell techniques apart and that no photograph has.
#pragma once

#include <string>
#include <vector>

#include "relievo/height_map.hpp"

namespace relievo::cli {

struct NamedMap {
  std::string name;
  HeightMap height;
};

/// Terraces, spikes, ridges, checkerboard, noise and hills, `size`² texels each, that repeat without a seam.
std::vector<NamedMap> make_synthetic_maps(int size);

}  // namespace relievo::cli
