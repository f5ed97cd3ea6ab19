/// What the maps of cones over cells promise (shaders/lib/cone.glsl), checked by definition: against every cell that a
/// ray can reach, one at a time.
#pragma once

#include <string>

#include "relievo/certify.hpp"

namespace relievo::certifiers {

/// For texels (M, A, √s): M bounds the cell, and A + s · distance every cell within reach in the texel's sector.
/// `sectors`: layers of the map, or 0 for one layer that looks everywhere. Of large maps, a fixed sample of cells.
Status check_cones(const HeightMap& height_map, const MapData& map, int sectors, int reach,
                   const CertifyOptions& options, Certificate& certificate);

/// An integer parameter "map.name" that the map was baked with.
int baked_with(const CertifyOptions& options, const std::string& name, int fallback);

}  // namespace relievo::certifiers
