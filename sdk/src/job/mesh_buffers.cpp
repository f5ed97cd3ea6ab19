#include "job/mesh_buffers.hpp"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "job/vectors.hpp"

namespace relievo {

namespace {

/// Every triangle with three vertices of its own.
Mesh explode(const Mesh& mesh) {
  Mesh result;
  result.name = mesh.name;
  for (const auto& triangle : mesh.triangles) {
    std::uint32_t first = static_cast<std::uint32_t>(result.positions.size());
    for (std::uint32_t vertex : triangle) {
      result.positions.push_back(mesh.positions[vertex]);
      result.normals.push_back(mesh.normals[vertex]);
      result.uvs.push_back(mesh.uvs[vertex]);
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// Survey Eq. 6: |T × B| / ((|T|² + |B|²)/2), the length of N relative to the frame.
float frame_length(const TriangleFrame& frame) {
  glm::vec3 t = to_vec3(frame.tangent), b = to_vec3(frame.bitangent);
  float mean = 0.5f * (glm::dot(t, t) + glm::dot(b, b));
  return mean > 0 ? glm::length(glm::cross(t, b)) / std::sqrt(mean) : 0.0f;
}

/// Scales the normals by the frame's length, averaged over the triangles that meet at a position so that nothing tears.
void scale_to_frames(Mesh& exploded, const std::vector<TriangleFrame>& frames, const std::vector<std::uint32_t>& weld) {
  std::vector<double> sums(exploded.positions.size(), 0.0);
  std::vector<int> counts(exploded.positions.size(), 0);
  for (std::size_t v = 0; v < exploded.positions.size(); ++v) {
    sums[weld[v]] += static_cast<double>(frame_length(frames[v / 3]));
    ++counts[weld[v]];
  }
  for (std::size_t v = 0; v < exploded.positions.size(); ++v) {
    float factor = static_cast<float>(sums[weld[v]] / counts[weld[v]]);
    for (float& c : exploded.normals[v]) c *= factor;
  }
}

}  // namespace

MeshBuffers make_mesh_buffers(const Mesh& mesh, DisplacementUnits units, int tessellation) {
  std::vector<TriangleFrame> frames = triangle_frames(mesh);
  Mesh pieces = explode(mesh);
  std::vector<std::uint32_t> weld = weld_positions(pieces);
  if (units == DisplacementUnits::frame) scale_to_frames(pieces, frames, weld);
  MeshBuffers buffers;
  for (const TriangleFrame& frame : frames) buffers.degenerate_triangles += frame.degenerate;
  std::size_t per_triangle = 1;
  if (tessellation > 1) {
    pieces = subdivide(pieces, tessellation);
    per_triangle = static_cast<std::size_t>(tessellation) * static_cast<std::size_t>(tessellation);
    weld.assign(pieces.positions.size(), 0);
  }
  buffers.vertices.resize(pieces.positions.size());
  buffers.indices.reserve(pieces.triangles.size() * 3);
  for (std::size_t t = 0; t < pieces.triangles.size(); ++t) {
    const TriangleFrame& frame = frames[t / per_triangle];
    for (std::uint32_t v : pieces.triangles[t]) {
      buffers.vertices[v] = {pieces.positions[v], pieces.normals[v], pieces.uvs[v],
                             frame.tangent,       frame.bitangent,   weld[v]};
      buffers.indices.push_back(v);
    }
  }
  return buffers;
}

std::vector<VertexAttribute> mesh_attributes(bool welded) {
  std::vector<VertexAttribute> attributes = {{0, Format::rgb32_float, offsetof(MeshVertex, position)},
                                             {1, Format::rgb32_float, offsetof(MeshVertex, extrusion)},
                                             {2, Format::rg32_float, offsetof(MeshVertex, uv)},
                                             {3, Format::rgb32_float, offsetof(MeshVertex, tangent)},
                                             {4, Format::rgb32_float, offsetof(MeshVertex, bitangent)}};
  if (welded) attributes.push_back({5, Format::r32_uint, offsetof(MeshVertex, weld)});
  return attributes;
}

}  // namespace relievo
