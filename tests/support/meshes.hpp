/// Facts about meshes that tests check.
#pragma once

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo::test {

/// What breaks a closed surface, by welded position: an edge that its neighbour does not run the other way exactly
/// once.
inline std::string closedness_fault(const Mesh& mesh) {
  const auto ids = weld_positions(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{ids[triangle[k]], ids[triangle[(k + 1) % 3]]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count == 1 && opposite != edges.end() && opposite->second == 1) continue;
    return "edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second);
  }
  return {};
}

/// The positions that carry more than one normal: there extrusion tears the surface open.
inline std::size_t split_normals(const Mesh& mesh) {
  const auto ids = weld_positions(mesh);
  std::map<std::uint32_t, std::set<std::array<float, 3>>> normals;
  for (std::size_t i = 0; i < ids.size(); ++i) normals[ids[i]].insert(mesh.normals[i]);
  std::size_t split = 0;
  for (const auto& [id, set] : normals) split += set.size() > 1 ? 1 : 0;
  return split;
}

inline double surface_area(const Mesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p = to_double(mesh.positions[a]);
    area += 0.5 * glm::length(glm::cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p));
  }
  return area;
}

/// Signed: positive when the triangles face outwards.
inline double enclosed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume +=
        glm::dot(to_double(mesh.positions[a]), glm::cross(to_double(mesh.positions[b]), to_double(mesh.positions[c]))) /
        6;
  }
  return volume;
}

/// Signed areas in texture space, one a triangle.
inline std::vector<double> uv_areas(const Mesh& mesh) {
  std::vector<double> areas;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec2 t = to_double(mesh.uvs[a]);
    areas.push_back(0.5 * cross2(to_double(mesh.uvs[b]) - t, to_double(mesh.uvs[c]) - t));
  }
  return areas;
}

/// How far a frame is from survey Eq. 2, p − p0 = (u − u0)T + (v − v0)B, over the length of the longest such
/// difference.
inline double frame_error(const Mesh& mesh, std::size_t t, const TriangleFrame& frame) {
  const auto& triangle = mesh.triangles[t];
  double error = 0, longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const glm::dvec3 p = to_double(mesh.positions[triangle[k]]) - to_double(mesh.positions[triangle[0]]);
    const glm::dvec2 uv = to_double(mesh.uvs[triangle[k]]) - to_double(mesh.uvs[triangle[0]]);
    error = std::max(error, glm::length(p - uv.x * to_double(frame.tangent) - uv.y * to_double(frame.bitangent)));
    longest = std::max(longest, glm::length(p));
  }
  return error / longest;
}

}  // namespace relievo::test
