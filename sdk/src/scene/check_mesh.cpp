#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/frames.hpp"

namespace relievo {

namespace {

std::string title(const Mesh& mesh) {
  return mesh.name.empty() ? "the mesh" : fmt::format("mesh '{}'", mesh.name);
}

Status check_counts(const Mesh& mesh, bool needs_uvs) {
  const std::size_t vertices = mesh.positions.size();
  if (vertices == 0 || mesh.triangles.empty()) {
    return fail(ErrorCode::io, "mesh.empty",
                fmt::format("{} has {} vertices and {} triangles; at least one triangle is expected", title(mesh),
                            vertices, mesh.triangles.size()));
  }
  if (mesh.uvs.empty() && needs_uvs) {
    return fail(ErrorCode::io, "mesh.uv",
                fmt::format("{} has no texture coordinates; a height map needs them (uv = \"spherical\" makes some)",
                            title(mesh)));
  }
  if ((!mesh.uvs.empty() && mesh.uvs.size() != vertices) ||
      (!mesh.normals.empty() && mesh.normals.size() != vertices)) {
    return fail(ErrorCode::io, "mesh.counts",
                fmt::format("{} has {} positions, {} normals and {} texture coordinates; as many of each are expected",
                            title(mesh), vertices, mesh.normals.size(), mesh.uvs.size()));
  }
  return {};
}

template <std::size_t N>
Status check_finite(const Mesh& mesh, const std::vector<std::array<float, N>>& values, const char* what) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const float value : values[i]) {
      if (std::isfinite(value)) continue;
      return fail(ErrorCode::io, "mesh.non-finite",
                  fmt::format("{} has {} in the {} of vertex {}; a finite number is expected", title(mesh),
                              std::isnan(value) ? "NaN" : "Inf", what, i));
    }
  }
  return {};
}

Status check_indices(const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    const std::uint32_t largest = *std::max_element(triangle.begin(), triangle.end());
    if (largest < mesh.positions.size()) continue;
    return fail(ErrorCode::io, "mesh.index",
                fmt::format("{} has vertex {} in triangle {}; below {} is expected", title(mesh), largest, t,
                            mesh.positions.size()));
  }
  return {};
}

}  // namespace

Result<MeshReport> check_mesh(const Mesh& mesh, bool needs_uvs) {
  if (auto counts = check_counts(mesh, needs_uvs); !counts) return tl::unexpected(counts.error());
  if (auto finite = check_finite(mesh, mesh.positions, "position"); !finite) return tl::unexpected(finite.error());
  if (auto finite = check_finite(mesh, mesh.normals, "normal"); !finite) return tl::unexpected(finite.error());
  if (auto finite = check_finite(mesh, mesh.uvs, "texture coordinate"); !finite) return tl::unexpected(finite.error());
  if (auto indices = check_indices(mesh); !indices) return tl::unexpected(indices.error());
  MeshReport report;
  report.triangles = mesh.triangles.size();
  for (const auto& triangle : mesh.triangles) {
    const TriangleEdges edges = triangle_edges(mesh, triangle);
    if (!has_area(edges)) {
      ++report.degenerate_triangles;
    } else if (!mesh.uvs.empty() && !has_uv_area(edges)) {
      ++report.degenerate_uvs;
    }
  }
  return report;
}

}  // namespace relievo
