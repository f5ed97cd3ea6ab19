#include <algorithm>
#include <cmath>
#include <numbers>

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo {

namespace {

struct Vertex {
  glm::dvec3 position, normal;
  glm::dvec2 uv;
};

std::uint32_t add(Mesh& mesh, const Vertex& vertex) {
  mesh.positions.push_back(to_float(vertex.position));
  mesh.normals.push_back(to_float(vertex.normal));
  mesh.uvs.push_back(to_float(vertex.uv));
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// Adds (columns+1)×(rows+1) vertices, u along the columns and v along the rows, and two triangles a cell.
template <class VertexAt>
void add_grid(Mesh& mesh, int columns, int rows, const VertexAt& vertex_at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) add(mesh, vertex_at(i, j));
  }
  const auto stride = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i, b = a + 1, c = b + stride, d = a + stride;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
}

/// The direction at `i` of `slices` around Z; the last is bit-equal to the first, so that seams close.
glm::dvec2 around(int i, int slices) {
  const double angle = 2 * std::numbers::pi * (i % slices) / slices;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Mesh make_plane(float size) {
  Mesh mesh;
  mesh.name = "plane";
  add_grid(mesh, 1, 1, [size](int i, int j) {
    const glm::dvec2 uv(i, j);
    return Vertex{glm::dvec3((uv - 0.5) * static_cast<double>(size), 0), {0, 0, 1}, uv};
  });
  return mesh;
}

Mesh make_sphere(float radius, int slices, int stacks) {
  slices = std::max(slices, 3);
  stacks = std::max(stacks, 2);
  const auto vertex_at = [=](double u, glm::dvec2 direction, int j) {
    const double latitude = std::numbers::pi * (static_cast<double>(j) / stacks - 0.5);
    const bool pole = j == 0 || j == stacks;
    const glm::dvec3 normal =
        pole ? glm::dvec3(0, 0, j == 0 ? -1 : 1) : glm::dvec3(direction * std::cos(latitude), std::sin(latitude));
    return Vertex{normal * static_cast<double>(radius), normal, {u, static_cast<double>(j) / stacks}};
  };
  Mesh mesh;
  mesh.name = "sphere";
  add_grid(mesh, slices, stacks - 2,
           [&](int i, int j) { return vertex_at(static_cast<double>(i) / slices, around(i, slices), j + 1); });
  const std::uint32_t last_ring = static_cast<std::uint32_t>(stacks - 2) * static_cast<std::uint32_t>(slices + 1);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(slices); ++i) {
    const double u = (i + 0.5) / slices;
    mesh.triangles.push_back({add(mesh, vertex_at(u, {}, 0)), i + 1, i});
    mesh.triangles.push_back({add(mesh, vertex_at(u, {}, stacks)), last_ring + i, last_ring + i + 1});
  }
  return mesh;
}

Mesh make_cylinder(float radius, float height, int slices) {
  slices = std::max(slices, 3);
  Mesh mesh;
  mesh.name = "cylinder";
  add_grid(mesh, slices, 1, [=](int i, int j) {
    const glm::dvec3 normal(around(i, slices), 0);
    const glm::dvec3 base(0, 0, (j - 0.5) * static_cast<double>(height));
    return Vertex{normal * static_cast<double>(radius) + base, normal, {static_cast<double>(i) / slices, j}};
  });
  return mesh;
}

Mesh make_torus(float major_radius, float minor_radius, int slices, int stacks) {
  slices = std::max(slices, 3);
  stacks = std::max(stacks, 3);
  Mesh mesh;
  mesh.name = "torus";
  add_grid(mesh, slices, stacks, [=](int i, int j) {
    const glm::dvec2 ring = around(i, slices), tube = around(j, stacks);
    const glm::dvec3 normal(ring * tube.x, tube.y);
    const glm::dvec3 centre(ring * static_cast<double>(major_radius), 0);
    return Vertex{centre + normal * static_cast<double>(minor_radius),
                  normal,
                  {static_cast<double>(i) / slices, static_cast<double>(j) / stacks}};
  });
  return mesh;
}

}  // namespace relievo
