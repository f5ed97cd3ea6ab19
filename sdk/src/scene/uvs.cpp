#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo {

namespace {

struct Projected {
  double u = 0, v = 0;
  bool is_pole = false;
};

glm::dvec3 centre_of_bounds(const Mesh& mesh) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& position : mesh.positions) {
    low = glm::min(low, to_double(position));
    high = glm::max(high, to_double(position));
  }
  return 0.5 * (low + high);
}

/// Longitude in [0,1) and latitude in [0,1]; on the axis longitude is open.
Projected project(const glm::dvec3& direction) {
  constexpr double on_axis = 1e-6;
  const double ring = std::hypot(direction.x, direction.y);
  Projected result;
  result.v = std::atan2(direction.z, ring) / std::numbers::pi + 0.5;
  result.is_pole = !(ring > on_axis * glm::length(direction));
  if (!result.is_pole) {
    const double u = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
    result.u = u < 0 ? u + 1 : u;
  }
  return result;
}

/// Takes the three corners to one sheet: those more than half a turn behind the furthest go once around.
void unwrap(std::array<Projected, 3>& corners) {
  double furthest = 0, sum = 0;
  int count = 0;
  for (const Projected& corner : corners) {
    if (!corner.is_pole) furthest = std::max(furthest, corner.u);
  }
  for (Projected& corner : corners) {
    if (corner.is_pole) continue;
    if (furthest - corner.u > 0.5) corner.u += 1;
    sum += corner.u;
    ++count;
  }
  for (Projected& corner : corners) {
    if (corner.is_pole && count > 0) corner.u = sum / count;
  }
}

}  // namespace

void scale_uvs(Mesh& mesh, std::array<float, 2> factor) {
  for (auto& uv : mesh.uvs) uv = {uv[0] * factor[0], uv[1] * factor[1]};
}

void project_spherical_uvs(Mesh& mesh) {
  const glm::dvec3 centre = centre_of_bounds(mesh);
  const bool has_normals = mesh.normals.size() == mesh.positions.size();
  Mesh projected;
  projected.name = mesh.name;
  std::map<std::pair<std::uint32_t, std::array<float, 2>>, std::uint32_t> vertices;
  for (const auto& triangle : mesh.triangles) {
    std::array<Projected, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = project(to_double(mesh.positions[triangle[k]]) - centre);
    unwrap(corners);
    std::array<std::uint32_t, 3> indices;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<float, 2> uv = to_float(glm::dvec2(corners[k].u, corners[k].v));
      const auto next = static_cast<std::uint32_t>(projected.positions.size());
      const auto [found, is_new] = vertices.try_emplace({triangle[k], uv}, next);
      indices[k] = found->second;
      if (!is_new) continue;
      projected.positions.push_back(mesh.positions[triangle[k]]);
      if (has_normals) projected.normals.push_back(mesh.normals[triangle[k]]);
      projected.uvs.push_back(uv);
    }
    projected.triangles.push_back(indices);
  }
  mesh = std::move(projected);
}

}  // namespace relievo
