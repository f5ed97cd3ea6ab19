/// Which triangles have no area; shared by what counts them and what frames them.
#pragma once

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo {

/// The two edges from a triangle's first corner, in space and in texture space.
struct TriangleEdges {
  glm::dvec3 p1, p2;
  glm::dvec2 t1, t2;
};

TriangleEdges triangle_edges(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);
bool has_area(const TriangleEdges& edges);
bool has_uv_area(const TriangleEdges& edges);

}  // namespace relievo
