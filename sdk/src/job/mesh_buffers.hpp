/// A mesh as vertex and index buffers of a drawing stage.
#pragma once

#include <cstdint>
#include <vector>

#include "relievo/job.hpp"
#include "relievo/mesh.hpp"
#include "relievo/scene.hpp"

namespace relievo {

/// The twin of shaders/lib/vertex_input.glsl.
struct MeshVertex {
  std::array<float, 3> position;
  std::array<float, 3> extrusion;  // displacement of height 1
  std::array<float, 2> uv;
  std::array<float, 3> tangent, bitangent;
  std::uint32_t weld;
};

struct MeshBuffers {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::uint64_t degenerate_triangles = 0;
};

/// Each triangle gets vertices of its own, for its frame is its own; with `tessellation` > 1 it is cut into
/// tessellation² that share vertices among themselves.
MeshBuffers make_mesh_buffers(const Mesh& mesh, DisplacementUnits units, int tessellation);

/// `welded`: with the weld ids, which only prisms read.
std::vector<VertexAttribute> mesh_attributes(bool welded);

}  // namespace relievo
