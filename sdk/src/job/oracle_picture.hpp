/// The truth of a picture: exact first hits of its pixels, in the form that techniques/oracle replays.
#pragma once

#include "relievo/image.hpp"
#include "relievo/maps.hpp"
#include "relievo/scene.hpp"

namespace relievo {

HeightMap height_map_of(const MapSet& maps);

/// Hits of the rays that the surface stage wrote (AOVs ray_origin and ray_direction), cell 0.
MapData exact_surface_hits(const HeightMap& height, const Image& origins, const Image& directions);

/// Hits of the view rays in the tetrahedra of the mesh's prisms, found on the CPU in double precision and apart from
/// the stage's shaders: for each pixel the nearest hit of all tetrahedra on its ray, with the tetrahedron's number as
/// cell (3 · triangle + index), or cell −1 where nothing is hit.
MapData exact_prism_hits(const HeightMap& height, const Scene& scene, const Mesh& mesh);

}  // namespace relievo
