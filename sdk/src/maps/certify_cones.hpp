/// What the maps of cones over cells promise (shaders/lib/cone.glsl), checked by definition: against every cell that a
/// ray can reach, one at a time.
#pragma once

#include "relievo/certify.hpp"

namespace relievo::certifiers {

/// For texels (M, A, √s): M bounds the cell, and A + s · distance every cell within reach in the texel's sector.
/// `by_sector`: the map has the parameter `sectors` and as many layers, else one layer that looks everywhere. Of large
/// maps, a fixed sample of cells is checked.
Status check_cones(const HeightMap& height_map, const MapData& map, bool by_sector, const CertifyOptions& options,
                   Certificate& certificate);

}  // namespace relievo::certifiers
