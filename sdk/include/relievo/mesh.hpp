/// Triangle meshes: what a height map is wrapped around.
/// Every function here is thread-safe; those that take a `Mesh&` change that mesh.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

/// Indexed triangles, counter-clockwise as seen from outside. Per vertex: a position, a normal (unit length in a mesh
/// of our own; empty = not given), and a texture coordinate, which may lie outside [0,1]: the map repeats.
struct Mesh {
  std::string name;
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Two triangles in z = 0, `size` wide, centred; uv is [0,1]² with u along +x and v along +y; the normal is +Z.
Mesh make_plane(float size = 2.0f);

/// A sphere around the origin with its poles on ±Z: u runs once around (0 at +X, towards +Y), v from the south pole (0)
/// to the north. The seam has its vertices twice (u = 0 and u = 1); each pole has one vertex a slice, so no triangle
/// has zero area. slices ≥ 3 around, stacks ≥ 2 from pole to pole; smaller values are raised to these.
Mesh make_sphere(float radius = 1.0f, int slices = 32, int stacks = 16);

/// The side of a cylinder around Z, from z = −height/2 (v = 0) to +height/2 (v = 1); u as on the sphere. slices ≥ 3.
Mesh make_cylinder(float radius = 1.0f, float height = 2.0f, int slices = 32);

/// A torus around Z: u runs around the axis, v around the tube (0 at the outer equator, towards +Z); periodic both
/// ways. slices ≥ 3 around the axis, stacks ≥ 3 around the tube.
Mesh make_torus(float major_radius = 1.0f, float minor_radius = 0.4f, int slices = 32, int stacks = 16);

/// What `check_mesh` counts; such triangles are legal and are drawn undisplaced.
struct MeshReport {
  std::uint64_t triangles = 0;
  std::uint64_t degenerate_triangles = 0;  ///< zero area in space
  std::uint64_t degenerate_uvs = 0;        ///< area in space, but none in texture space
};

/// Validates what everything else relies on. Errors ("mesh.empty", "mesh.counts", "mesh.index", "mesh.non-finite",
/// "mesh.uv") name the mesh and the vertex or triangle. Missing normals are allowed, `weld_normals` makes them; missing
/// texture coordinates are where `needs_uvs` is false, for `project_spherical_uvs` (degenerate_uvs then stays 0).
Result<MeshReport> check_mesh(const Mesh& mesh, bool needs_uvs = true);

/// Cuts every triangle into factor² by linear interpolation of position, normal and uv. The normal is not renormalised:
/// displaced vertices then lie on the surface that the prisms of the coarse triangles describe.
/// Edges shared by index stay shared; vertices with bit-equal attributes along an edge cut it at bit-equal points.
/// factor ≥ 1; 1 returns a copy.
Mesh subdivide(const Mesh& mesh, int factor);

/// One id a vertex, equal exactly where positions are equal (−0 = +0). Ids ascend with the position (x, then y, then
/// z), so that they do not depend on the order of the vertices and both sides of an edge order its ends alike.
std::vector<std::uint32_t> weld_positions(const Mesh& mesh);

/// Gives vertices at one position one unit normal, so that extrusion along it leaves no gap: the average of the
/// normals given, or without any, of the face normals weighted by their angle at the vertex.
/// Sums run in an order fixed by geometry alone. Where they cancel, the normal is +Z.
void weld_normals(Mesh& mesh);

/// The columns ∂p/∂u and ∂p/∂v of a triangle: survey Eq. 5, not normalised, in world units per unit of u or v.
struct TriangleFrame {
  std::array<float, 3> tangent = {}, bitangent = {};
  bool degenerate = false;  ///< no area in space or in texture space: both are zero; draw it undisplaced
};

/// One frame a triangle, computed in double. Needs uvs.
std::vector<TriangleFrame> triangle_frames(const Mesh& mesh);

/// Multiplies the texture coordinates.
void scale_uvs(Mesh& mesh, std::array<float, 2> factor);

/// Replaces the texture coordinates by longitude and latitude around the Z axis through the centre of the bounds, as
/// `make_sphere` lays them out. Each triangle is unwrapped by itself: across the seam u goes beyond 1 (the map must
/// repeat in u), and a corner at a pole gets the mean u of the two others; vertices are duplicated for both.
void project_spherical_uvs(Mesh& mesh);

/// The same surface with vertices renumbered, triangles reordered and corners rotated (winding kept), for tests that
/// the order does not matter. Deterministic in `seed`.
Mesh shuffle(const Mesh& mesh, std::uint64_t seed);

}  // namespace relievo
