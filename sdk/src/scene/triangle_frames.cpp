#include <algorithm>
#include <cmath>

#include "scene/frames.hpp"

namespace relievo {

namespace {

/// Twice a triangle's area over its longest edge squared; below this, rounding decides its shape.
constexpr double flatness = 1e-12;

bool is_finite(const std::array<float, 3>& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Survey Eq. 5 solved by Cramer's rule; both denominators there are the same but for the sign.
TriangleFrame frame_of(const TriangleEdges& e) {
  if (!has_area(e) || !has_uv_area(e)) return {{}, {}, true};
  const double determinant = cross2(e.t1, e.t2);
  const auto tangent = to_float((e.t2.y * e.p1 - e.t1.y * e.p2) / determinant);
  const auto bitangent = to_float((e.t1.x * e.p2 - e.t2.x * e.p1) / determinant);
  if (!is_finite(tangent) || !is_finite(bitangent)) return {{}, {}, true};
  return {tangent, bitangent, false};
}

}  // namespace

TriangleEdges triangle_edges(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  TriangleEdges edges = {};
  edges.p1 = to_double(mesh.positions[b]) - to_double(mesh.positions[a]);
  edges.p2 = to_double(mesh.positions[c]) - to_double(mesh.positions[a]);
  if (!mesh.uvs.empty()) {
    edges.t1 = to_double(mesh.uvs[b]) - to_double(mesh.uvs[a]);
    edges.t2 = to_double(mesh.uvs[c]) - to_double(mesh.uvs[a]);
  }
  return edges;
}

bool has_area(const TriangleEdges& e) {
  const glm::dvec3 third = e.p2 - e.p1;
  const double longest = std::max({glm::dot(e.p1, e.p1), glm::dot(e.p2, e.p2), glm::dot(third, third)});
  return glm::length(glm::cross(e.p1, e.p2)) > flatness * longest;
}

bool has_uv_area(const TriangleEdges& e) {
  const glm::dvec2 third = e.t2 - e.t1;
  const double longest = std::max({glm::dot(e.t1, e.t1), glm::dot(e.t2, e.t2), glm::dot(third, third)});
  return std::abs(cross2(e.t1, e.t2)) > flatness * longest;
}

std::vector<TriangleFrame> triangle_frames(const Mesh& mesh) {
  std::vector<TriangleFrame> frames;
  frames.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) frames.push_back(frame_of(triangle_edges(mesh, triangle)));
  return frames;
}

}  // namespace relievo
