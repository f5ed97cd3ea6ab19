#include "mesh_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "relievo/scene.hpp"
#include "support/files.hpp"
#include "support/meshes.hpp"

namespace relievo::test {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path models = "/usr/share/glmark2/models";

constexpr const char* quad = R"(v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3 4/4
)";

/// A scene whose mesh is this file; what the CLI draws.
Result<Mesh> scene_mesh_of(const std::filesystem::path& path, UvSource uv = UvSource::file) {
  Scene scene;
  scene.mesh.kind = MeshKind::file;
  scene.mesh.path = path;
  scene.mesh.uv = uv;
  return scene_mesh(scene, cli::load_mesh_file);
}

void expect_error(const std::filesystem::path& path, const std::string& id, const std::string& part) {
  const auto mesh = scene_mesh_of(path);
  ASSERT_FALSE(mesh) << path;
  EXPECT_EQ(mesh.error().id, id) << mesh.error().message;
  EXPECT_EQ(mesh.error().file, path.string());
  EXPECT_THAT(mesh.error().message, HasSubstr(fmt::format("'{}'", path.filename().string())));
  EXPECT_THAT(mesh.error().message, HasSubstr(part));
  EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
}

TEST(MeshFile, PolygonsBecomeTrianglesAndVIsTurnedOver) {
  const TemporaryFolder folder;
  const auto mesh = scene_mesh_of(folder.write("quad.obj", quad));
  ASSERT_TRUE(mesh) << format(mesh.error());
  EXPECT_EQ(mesh->triangles.size(), 2u);
  ASSERT_EQ(mesh->positions.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(mesh->uvs[i], (std::array{mesh->positions[i][0], 1 - mesh->positions[i][1]}));
    EXPECT_EQ(mesh->normals[i], (std::array{0.0f, 0.0f, 1.0f}));
  }
}

TEST(MeshFile, MissingEmptyFolderAndText) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.obj");
  expect_error(folder / "none.obj", "mesh.missing", "does not exist");
  expect_error(folder.write("empty.obj", ""), "mesh.empty", "is empty");
  expect_error(folder / "folder.obj", "mesh.unreadable", "is a folder");
  expect_error(folder.write("text.dat", "no mesh"), "mesh.unreadable", "cannot be read as a mesh");
  expect_error(folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "mesh.unreadable",
               "cannot be read as a mesh");
}

TEST(MeshFile, MissingTextureCoordinatesAreAnErrorUnlessProjected) {
  const TemporaryFolder folder;
  const auto path = folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
  expect_error(path, "mesh.uv", "has no texture coordinates");
  EXPECT_TRUE(scene_mesh_of(path, UvSource::spherical).has_value());
}

TEST(MeshFile, NonFiniteCoordinatesAreNamed) {
  const TemporaryFolder folder;
  std::string text = quad;
  text.replace(text.find("v 1 1 0"), 7, "v 1 nan 0");
  expect_error(folder.write("nan.obj", text), "mesh.non-finite", "NaN in the position of vertex");
}

TEST(MeshFile, IndicesOutOfRangeDoNotCrash) {
  const TemporaryFolder folder;
  const auto path = folder.write("index.obj", std::string(quad) + "f 1/1 2/2 900/3\n");
  const auto mesh = scene_mesh_of(path);
  if (mesh) {
    EXPECT_TRUE(check_mesh(*mesh).has_value());
  } else {
    EXPECT_THAT(mesh.error().message, HasSubstr("'index.obj'"));
  }
}

TEST(MeshFile, DegenerateTrianglesAreCountedNotRejected) {
  const TemporaryFolder folder;
  const auto mesh = scene_mesh_of(folder.write("line.obj", std::string(quad) + "f 1/1 2/2 2/2\nf 1/1 2/1 3/1\n"));
  ASSERT_TRUE(mesh) << format(mesh.error());
  const auto report = check_mesh(*mesh);
  EXPECT_EQ(report->degenerate_triangles + report->degenerate_uvs, 2u);
}

TEST(MeshFile, TruncatedModelsDoNotCrash) {
  const TemporaryFolder folder;
  const ByteString model = TemporaryFolder::read(models / "asteroid-low.3ds");
  for (std::size_t length = 1; length < model.size(); length += 1 + model.size() / 100) {
    const auto mesh = scene_mesh_of(folder.write("cut.3ds", std::string_view(model).substr(0, length)));
    if (mesh) {
      EXPECT_TRUE(check_mesh(*mesh).has_value()) << length;
    } else {
      EXPECT_THAT(mesh.error().message, HasSubstr("'cut.3ds'")) << length;
    }
  }
}

TEST(MeshFile, LowAsteroidIsClosedOutwardAndTextured) {
  const auto mesh = scene_mesh_of(models / "asteroid-low.3ds");
  ASSERT_TRUE(mesh) << format(mesh.error());
  EXPECT_EQ(mesh->triangles.size(), 480u);
  EXPECT_EQ(mesh->positions.size(), 262u);
  EXPECT_EQ(closedness_fault(*mesh), "");
  EXPECT_NEAR(enclosed_volume(*mesh), 3.64, 0.01);
  EXPECT_EQ(split_normals(*mesh), 0u);
  const auto areas = uv_areas(*mesh);
  EXPECT_LT(*std::max_element(areas.begin(), areas.end()), 0) << "turning v over mirrors every triangle";
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), -0.4427, 1e-3);
  const auto frames = triangle_frames(*mesh);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    EXPECT_FALSE(frames[t].degenerate);
    EXPECT_LT(frame_error(*mesh, t, frames[t]), 1e-5);
  }
}

TEST(MeshFile, HighAsteroidAndBunnyNeedProjectedUvs) {
  for (const char* name : {"asteroid-high.3ds", "bunny.obj"}) {
    EXPECT_EQ(scene_mesh_of(models / name).error().id, "mesh.uv") << name;
    const auto mesh = scene_mesh_of(models / name, UvSource::spherical);
    ASSERT_TRUE(mesh) << format(mesh.error());
    EXPECT_EQ(closedness_fault(*mesh), "") << name;
    EXPECT_EQ(split_normals(*mesh), 0u) << name;
    EXPECT_GT(enclosed_volume(*mesh), 1) << name;
    const auto wide = std::count_if(mesh->triangles.begin(), mesh->triangles.end(), [&](const auto& triangle) {
      const auto& [a, b, c] = triangle;
      const auto [low, high] = std::minmax({mesh->uvs[a][0], mesh->uvs[b][0], mesh->uvs[c][0]});
      return high - low > 0.5f;
    });
    EXPECT_LE(wide, 2) << name << ": only a triangle that the axis pierces is wide";
  }
}

}  // namespace
}  // namespace relievo::test
