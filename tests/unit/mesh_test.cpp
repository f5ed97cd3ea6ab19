#include "relievo/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

#include "support/meshes.hpp"

namespace relievo::test {
namespace {

using ::testing::HasSubstr;

constexpr double pi = std::numbers::pi;

Mesh triangle_mesh(std::array<std::array<float, 3>, 3> positions, std::array<std::array<float, 2>, 3> uvs) {
  Mesh mesh;
  mesh.name = "one";
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.uvs.assign(uvs.begin(), uvs.end());
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// A triangle as the sorted bytes of its corners, whatever their numbers.
using Corner = std::array<float, 8>;
using CornerTriple = std::array<Corner, 3>;
std::vector<CornerTriple> sorted_triangles(const Mesh& mesh) {
  std::vector<CornerTriple> result;
  for (const auto& triangle : mesh.triangles) {
    CornerTriple corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = mesh.positions[triangle[k]];
      const auto& n = mesh.normals[triangle[k]];
      const auto& t = mesh.uvs[triangle[k]];
      corners[k] = {p[0], p[1], p[2], n[0], n[1], n[2], t[0], t[1]};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(MeshGenerators, ClosedSurfacesAreClosedAndFaceOutwards) {
  for (const auto& [slices, stacks] : {std::array{3, 3}, {7, 5}, {32, 16}}) {
    const Mesh sphere = make_sphere(2, slices, stacks), torus = make_torus(2, 0.5f, slices, stacks);
    EXPECT_EQ(closedness_fault(sphere), "");
    EXPECT_EQ(closedness_fault(torus), "");
    EXPECT_GT(enclosed_volume(sphere), 0);
    EXPECT_GT(enclosed_volume(torus), 0);
  }
}

TEST(MeshGenerators, ClosednessCheckCatchesFaults) {
  Mesh missing = make_sphere(), turned = make_sphere();
  missing.triangles.erase(missing.triangles.begin() + 40);
  std::swap(turned.triangles[40][0], turned.triangles[40][1]);
  EXPECT_NE(closedness_fault(missing), "");
  EXPECT_NE(closedness_fault(turned), "");
  Mesh seam = make_torus();  // the seam's vertices are there twice: one side moves
  seam.positions[0][0] = std::nextafter(seam.positions[0][0], 9.0f);
  EXPECT_NE(closedness_fault(seam), "");
}

TEST(MeshGenerators, SizesConvergeToTheSolids) {
  EXPECT_NEAR(enclosed_volume(make_sphere(2, 256, 128)), 4.0 / 3 * pi * 8, 0.02);
  EXPECT_NEAR(enclosed_volume(make_torus(2, 0.5f, 256, 128)), 2 * pi * pi * 2 * 0.25, 0.01);
  EXPECT_NEAR(surface_area(make_cylinder(1, 3, 512)), 2 * pi * 3, 1e-3);
  EXPECT_NEAR(surface_area(make_plane(3)), 9, 1e-6);
}

TEST(MeshGenerators, TextureCoversTheUnitSquareOnceWithoutMirroring) {
  for (const Mesh& mesh : {make_plane(), make_cylinder(), make_torus()}) {
    const auto areas = uv_areas(mesh);
    EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 1, 1e-6) << mesh.name;
    EXPECT_GT(*std::min_element(areas.begin(), areas.end()), 0) << mesh.name;
  }
  const auto sphere = uv_areas(make_sphere(1, 32, 16));  // a fan of triangles covers half of the strip at each pole
  EXPECT_NEAR(std::accumulate(sphere.begin(), sphere.end(), 0.0), 1 - 1.0 / 16, 1e-6);
  EXPECT_GT(*std::min_element(sphere.begin(), sphere.end()), 0);
}

TEST(MeshGenerators, NormalsAreUnitOutwardAndOneAPosition) {
  for (const Mesh& mesh : {make_plane(), make_sphere(), make_cylinder(), make_torus()}) {
    EXPECT_EQ(split_normals(mesh), 0u) << mesh.name;
    for (const auto& normal : mesh.normals) EXPECT_NEAR(glm::length(to_double(normal)), 1, 1e-6) << mesh.name;
    for (const auto& [a, b, c] : mesh.triangles) {
      const glm::dvec3 p = to_double(mesh.positions[a]);
      const glm::dvec3 face = glm::cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p);
      EXPECT_GT(glm::dot(face, to_double(mesh.normals[a])), 0) << mesh.name;
    }
  }
}

TEST(MeshGenerators, SmallCountsAreRaised) {
  EXPECT_EQ(make_sphere(1, 0, -3).triangles.size(), make_sphere(1, 3, 2).triangles.size());
  EXPECT_EQ(closedness_fault(make_sphere(1, 0, 0)), "");
  EXPECT_TRUE(check_mesh(make_torus(1, 0.2f, 1, 1)).has_value());
}

TEST(CheckMesh, CountsDegenerateTriangles) {
  Mesh mesh = make_plane();
  mesh.triangles.push_back({0, 1, 1});
  const auto flat_uv = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t i = 0; i < 3; ++i) {
    mesh.positions.push_back(mesh.positions[i]);
    mesh.normals.push_back(mesh.normals[i]);
    mesh.uvs.push_back({0.5f, 0.5f});
  }
  mesh.triangles.push_back({flat_uv, flat_uv + 1, flat_uv + 2});
  const auto report = check_mesh(mesh);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->triangles, 4u);
  EXPECT_EQ(report->degenerate_triangles, 1u);
  EXPECT_EQ(report->degenerate_uvs, 1u);
}

TEST(CheckMesh, NamesTheFaultyVertexOrTriangle) {
  const auto error = [](auto&& spoil) {
    Mesh mesh = make_plane();
    spoil(mesh);
    const auto report = check_mesh(mesh);
    return report ? std::string("none") : report.error().id + ": " + report.error().message;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error([&](Mesh& m) { m.positions[2][1] = nan; }), HasSubstr("NaN in the position of vertex 2"));
  EXPECT_THAT(error([&](Mesh& m) { m.normals[3][0] = inf; }), HasSubstr("Inf in the normal of vertex 3"));
  EXPECT_THAT(error([&](Mesh& m) { m.uvs[1][1] = -inf; }), HasSubstr("Inf in the texture coordinate of vertex 1"));
  EXPECT_THAT(error([](Mesh& m) { m.triangles[1][2] = 4; }),
              HasSubstr("mesh.index: mesh 'plane' has vertex 4 in triangle 1"));
  EXPECT_THAT(error([](Mesh& m) { m.uvs.clear(); }), HasSubstr("mesh.uv: mesh 'plane' has no texture coordinates"));
  EXPECT_THAT(error([](Mesh& m) { m.uvs.pop_back(); }), HasSubstr("mesh.counts"));
  EXPECT_THAT(error([](Mesh& m) { m.triangles.clear(); }), HasSubstr("mesh.empty"));
  EXPECT_EQ(error([](Mesh&) {}), "none");
}

TEST(Subdivide, CutsEachTriangleIntoFactorSquared) {
  for (const int factor : {1, 2, 3, 7}) {
    const Mesh torus = make_torus(1, 0.4f, 8, 6);
    const Mesh fine = subdivide(torus, factor);
    EXPECT_EQ(fine.triangles.size(), torus.triangles.size() * static_cast<std::size_t>(factor * factor));
    EXPECT_NEAR(surface_area(fine), surface_area(torus), 1e-5);
    EXPECT_TRUE(check_mesh(fine).has_value());
  }
}

TEST(Subdivide, KeepsClosedSurfacesClosedAcrossSeams) {
  for (const Mesh& mesh : {make_sphere(1, 9, 6), make_torus(1, 0.3f, 9, 7)}) {
    EXPECT_EQ(closedness_fault(subdivide(mesh, 5)), "") << mesh.name;
    EXPECT_EQ(closedness_fault(subdivide(shuffle(mesh, 11), 5)), "") << mesh.name;
  }
}

TEST(Subdivide, InterpolatesNormalsWithoutRenormalising) {
  Mesh mesh = triangle_mesh({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}}, {{{0, 0}, {1, 0}, {0, 1}}});
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Mesh fine = subdivide(mesh, 2);
  ASSERT_EQ(fine.positions.size(), 6u);
  const std::vector<std::array<float, 3>> normals(fine.normals.begin() + 3, fine.normals.end());
  EXPECT_THAT(normals, testing::UnorderedElementsAre(std::array{0.5f, 0.5f, 0.0f}, std::array{0.5f, 0.0f, 0.5f},
                                                     std::array{0.0f, 0.5f, 0.5f}));
}

TEST(Subdivide, SharesEdgePointsByIndex) {
  EXPECT_EQ(subdivide(make_plane(), 4).positions.size(), 25u);
}

TEST(WeldPositions, IdsFollowPositionsAlone) {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {-0.0f, 0, 0}, {0, -0.0f, 0}, {-1, 5, 0}, {1, 0, 0}};
  EXPECT_EQ(weld_positions(mesh), (std::vector<std::uint32_t>{2, 1, 1, 0, 2}));
}

TEST(WeldPositions, NeighboursOrderTheirEdgesAlikeInAnyVertexOrder) {
  const Mesh torus = make_torus(1, 0.3f, 6, 5);
  std::map<std::array<float, 3>, std::uint32_t> id_at;
  const auto ids = weld_positions(torus);
  for (std::size_t i = 0; i < ids.size(); ++i) id_at[torus.positions[i]] = ids[i];
  const Mesh other = shuffle(torus, 3);
  const auto other_ids = weld_positions(other);
  for (std::size_t i = 0; i < other_ids.size(); ++i) EXPECT_EQ(id_at.at(other.positions[i]), other_ids[i]);
}

TEST(WeldNormals, ClosesAnOctahedronWithFlatNormals) {
  const Mesh octahedron = make_sphere(1, 4, 2);
  Mesh flat;  // each face with its own normal
  for (const auto& [a, b, c] : octahedron.triangles) {
    const auto first = static_cast<std::uint32_t>(flat.positions.size());
    const glm::dvec3 p = to_double(octahedron.positions[a]);
    const auto normal = to_float(
        glm::normalize(glm::cross(to_double(octahedron.positions[b]) - p, to_double(octahedron.positions[c]) - p)));
    for (const auto i : {a, b, c}) {
      flat.positions.push_back(octahedron.positions[i]);
      flat.normals.push_back(normal);
      flat.uvs.push_back(octahedron.uvs[i]);
    }
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(split_normals(flat), 6u);
  Mesh without = flat;
  without.normals.clear();
  for (Mesh* mesh : {&flat, &without}) {
    weld_normals(*mesh);
    EXPECT_EQ(split_normals(*mesh), 0u);
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {  // by symmetry the normal is the position
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mesh->normals[i][k], mesh->positions[i][k], 1e-6);
    }
  }
}

TEST(WeldNormals, DoesNotDependOnTheOrderOfTheMesh) {
  Mesh torus = make_torus(1, 0.3f, 11, 7);
  for (const bool given : {true, false}) {
    if (!given) torus.normals.clear();
    Mesh expected = torus, shuffled = shuffle(torus, 5);
    weld_normals(expected);
    weld_normals(shuffled);
    EXPECT_EQ(sorted_triangles(expected), sorted_triangles(shuffled)) << given;
  }
}

TEST(WeldNormals, GivesUpOnNormalsThatCancel) {
  Mesh mesh = triangle_mesh({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {{{0, 0}, {1, 0}, {0, 1}}});
  mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};
  weld_normals(mesh);
  EXPECT_EQ(mesh.normals[0], (std::array{0.0f, 0.0f, 1.0f}));
}

TEST(TriangleFrames, PlaneHasItsEdgesAsFrame) {
  for (const TriangleFrame& frame : triangle_frames(make_plane(2))) {
    EXPECT_EQ(frame.tangent, (std::array{2.0f, 0.0f, 0.0f}));
    EXPECT_EQ(frame.bitangent, (std::array{0.0f, 2.0f, 0.0f}));
    EXPECT_FALSE(frame.degenerate);
  }
}

TEST(TriangleFrames, SatisfyTheSurveysEquationSheared) {
  Mesh sheared = make_torus(1, 0.4f, 12, 9), mirrored = sheared;
  for (auto& uv : sheared.uvs) uv = {3 * uv[0] + 0.7f * uv[1], 0.2f * uv[1] - 5};
  for (auto& uv : mirrored.uvs) uv = {1 - uv[0], uv[1]};
  for (const Mesh& mesh : {sheared, mirrored}) {
    const auto frames = triangle_frames(mesh);
    for (std::size_t t = 0; t < frames.size(); ++t) EXPECT_LT(frame_error(mesh, t, frames[t]), 1e-6);
  }
}

TEST(TriangleFrames, ErrorCheckCatchesASwappedOrNormalisedFrame) {
  const Mesh plane = make_plane(2);
  TriangleFrame frame = triangle_frames(plane)[0], normalised = frame;
  std::swap(frame.tangent, frame.bitangent);
  normalised.tangent = {1, 0, 0};
  EXPECT_GT(frame_error(plane, 0, frame), 0.1);
  EXPECT_GT(frame_error(plane, 0, normalised), 0.1);
}

TEST(TriangleFrames, DegenerateTrianglesHaveAZeroFrame) {
  const std::array<std::array<float, 2>, 3> uvs = {{{0, 0}, {1, 0}, {0, 1}}};
  const std::array<std::array<float, 3>, 3> positions = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const Mesh line = triangle_mesh({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}}, uvs);
  const Mesh flat_uv = triangle_mesh(positions, {{{0, 0}, {1, 1}, {2, 2}}});
  const Mesh overflow = triangle_mesh({{{0, 0, 0}, {3e38f, 0, 0}, {0, 3e38f, 0}}}, {{{0, 0}, {1e-3f, 0}, {0, 1e-3f}}});
  for (const Mesh& mesh : {line, flat_uv, overflow}) {
    const TriangleFrame frame = triangle_frames(mesh)[0];
    EXPECT_TRUE(frame.degenerate);
    EXPECT_EQ(frame.tangent, (std::array<float, 3>{}));
    EXPECT_EQ(frame.bitangent, (std::array<float, 3>{}));
  }
  EXPECT_FALSE(triangle_frames(triangle_mesh(positions, uvs))[0].degenerate);
}

TEST(SphericalUvs, UnwrapTheSeamAndThePoles) {
  Mesh mesh = make_sphere(1, 24, 12);
  const Mesh original = mesh;
  mesh.uvs.clear();
  project_spherical_uvs(mesh);
  ASSERT_TRUE(check_mesh(mesh).has_value());
  EXPECT_EQ(mesh.triangles.size(), original.triangles.size());
  const auto areas = uv_areas(mesh), expected = uv_areas(original);
  for (std::size_t t = 0; t < areas.size(); ++t) EXPECT_NEAR(areas[t], expected[t], 1e-6) << t;
}

TEST(SphericalUvs, WithoutUnwrappingTheAreaCheckFails) {
  Mesh mesh = make_sphere(1, 24, 12);
  for (auto& uv : mesh.uvs) uv[0] = uv[0] >= 1 ? 0 : uv[0];
  const auto areas = uv_areas(mesh);
  EXPECT_LT(*std::min_element(areas.begin(), areas.end()), 0);
}

TEST(Shuffle, KeepsTheSurfaceAndItsWinding) {
  const Mesh mesh = make_torus(1, 0.3f, 7, 5);
  const Mesh once = shuffle(mesh, 1), again = shuffle(mesh, 1), other = shuffle(mesh, 2);
  EXPECT_EQ(sorted_triangles(once), sorted_triangles(mesh));
  EXPECT_EQ(once.triangles, again.triangles);
  EXPECT_NE(once.triangles, other.triangles);
  EXPECT_NE(once.positions, mesh.positions);
}

TEST(ScaleUvs, ScalesTheFrameInversely) {
  Mesh plane = make_plane(2);
  scale_uvs(plane, {2, 4});
  EXPECT_EQ(triangle_frames(plane)[0].tangent, (std::array{1.0f, 0.0f, 0.0f}));
  EXPECT_EQ(triangle_frames(plane)[0].bitangent, (std::array{0.0f, 0.5f, 0.0f}));
}

}  // namespace
}  // namespace relievo::test
