#include "relievo/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/files.hpp"
#include "support/meshes.hpp"

namespace relievo::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* full_scene = R"(
[mesh]
kind = "torus"
radius = 2
minor_radius = 0.5
slices = 24
stacks = 12
uv_scale = [4, 2.5]

[height_map]
path = "maps/a.png"
address = "mirror"

[displacement]
scale = -0.25
bias = 0.125
units = "frame"

[camera]
position = [1, 2, 3]
target = [0, 0, 0.5]
up = [0, 1, 0]
vertical_fov = 30
near = 0.5
far = 50

[[light]]
direction = [1, 0, 0]
color = [1, 0.5, 0]
[[light]]
direction = [0, 0, 2]

[material]
albedo = [0.1, 0.2, 0.3]
ambient = 0.05
specular = 0.4
shininess = 16

[image]
width = 320
height = 200
)";

TEST(Scene, ReadsEveryField) {
  const auto scene = parse_scene(full_scene, "/scenes/one.toml");
  ASSERT_TRUE(scene) << format(scene.error());
  EXPECT_EQ(scene->file, "/scenes/one.toml");
  EXPECT_EQ(scene->mesh.kind, MeshKind::torus);
  EXPECT_EQ(scene->mesh.radius, 2.0f);
  EXPECT_EQ(scene->mesh.minor_radius, 0.5f);
  EXPECT_EQ(scene->mesh.slices, 24);
  EXPECT_EQ(scene->mesh.stacks, 12);
  EXPECT_EQ(scene->mesh.uv_scale, (std::array{4.0f, 2.5f}));
  EXPECT_EQ(scene->height_map.path, "/scenes/maps/a.png");
  EXPECT_EQ(scene->height_map.address, AddressMode::mirror);
  EXPECT_EQ(scene->displacement.scale, -0.25f);
  EXPECT_EQ(scene->displacement.bias, 0.125f);
  EXPECT_EQ(scene->displacement.units, DisplacementUnits::frame);
  EXPECT_EQ(scene->camera.position, (std::array{1.0f, 2.0f, 3.0f}));
  EXPECT_EQ(scene->camera.target, (std::array{0.0f, 0.0f, 0.5f}));
  EXPECT_EQ(scene->camera.up, (std::array{0.0f, 1.0f, 0.0f}));
  EXPECT_EQ(scene->camera.vertical_fov, 30.0f);
  EXPECT_EQ(scene->camera.near_plane, 0.5f);
  EXPECT_EQ(scene->camera.far_plane, 50.0f);
  ASSERT_EQ(scene->lights.size(), 2u);
  EXPECT_EQ(scene->lights[0].color, (std::array{1.0f, 0.5f, 0.0f}));
  EXPECT_EQ(scene->lights[1].direction, (std::array{0.0f, 0.0f, 2.0f}));
  EXPECT_EQ(scene->material.albedo, (std::array{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(scene->material.ambient, 0.05f);
  EXPECT_EQ(scene->material.specular, 0.4f);
  EXPECT_EQ(scene->material.shininess, 16.0f);
  EXPECT_EQ(scene->image.width, 320);
  EXPECT_EQ(scene->image.height, 200);
}

TEST(Scene, EmptyTextIsTheDefaultScene) {
  const auto scene = parse_scene("", "empty.toml");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh.kind, MeshKind::plane);
  EXPECT_EQ(scene->lights.size(), 1u);
  EXPECT_TRUE(scene_mesh(*scene).has_value());
  EXPECT_EQ(scene_height_map(*scene)->texels, std::vector<float>{0.0f});
}

TEST(Scene, PathsResolveAgainstTheScenesFolder) {
  const auto path_of = [](const std::string& path) {
    const auto scene = parse_scene("[mesh]\nkind = \"file\"\npath = \"" + path + "\"", "/a/b/scene.toml");
    return scene ? scene->mesh.path.string() : scene.error().message;
  };
  EXPECT_EQ(path_of("x.3ds"), "/a/b/x.3ds");
  EXPECT_EQ(path_of("../c/x.3ds"), "/a/c/x.3ds");
  EXPECT_EQ(path_of("/x.3ds"), "/x.3ds");
}

struct Fault {
  const char* text;
  const char* id;
  int line, column;
  const char* sentence;  ///< a part of it
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.text;
}

class SceneFault : public ::testing::TestWithParam<Fault> {};

TEST_P(SceneFault, IsNamedWithItsPlace) {
  const auto scene = parse_scene(GetParam().text, "scene.toml");
  ASSERT_FALSE(scene) << GetParam().text;
  EXPECT_EQ(scene.error().id, GetParam().id) << scene.error().message;
  EXPECT_EQ(scene.error().line, GetParam().line) << scene.error().message;
  EXPECT_EQ(scene.error().column, GetParam().column) << scene.error().message;
  EXPECT_EQ(scene.error().file, "scene.toml");
  EXPECT_EQ(scene.error().code, ErrorCode::descriptor);
  EXPECT_THAT(scene.error().message, HasSubstr(GetParam().sentence));
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneFault,
    ::testing::Values(
        Fault{"[mehs]\n", "scene.unknown-key", 1, 2, "the nearest is \"mesh\""},
        Fault{"[mesh]\nknid = \"plane\"", "scene.unknown-key", 2, 1, "the nearest is \"kind\""},
        Fault{"[mesh]\nkind = \"plain\"", "scene.range", 2, 8, "the nearest is \"plane\""},
        Fault{"[mesh]\nradius = 2", "scene.unknown-key", 2, 1, "mesh of kind \"plane\" has the unknown key"},
        Fault{"[mesh]\nkind = \"file\"", "scene.missing-key", 1, 1, "lacks the key \"path\""},
        Fault{"[mesh]\nkind = \"sphere\"\nslices = 2", "scene.range", 3, 10, "from 3 to 4096"},
        Fault{"[mesh]\nkind = \"sphere\"\nslices = 2.5", "scene.type", 3, 10, "an integer is expected"},
        Fault{"[mesh]\nsize = 0", "scene.range", 2, 8, "is 0; a number above 0 is expected"},
        Fault{"[mesh]\nuv_scale = [1, 0]", "scene.range", 2, 12, "has a 0"},
        Fault{"[mesh]\nuv_scale = [1, 2, 3]", "scene.range", 2, 12, "has 3 places; 2 numbers"},
        Fault{"[mesh]\nuv_scale = 2", "scene.range", 2, 12, "is the integer 2; 2 numbers"},
        Fault{"mesh = 3", "scene.type", 1, 8, "a table is expected"},
        Fault{"[height_map]\naddress = \"clip\"", "scene.missing-key", 1, 1, "lacks the key \"path\""},
        Fault{"[height_map]\npath = \"a\"\naddress = \"repaet\"", "scene.range", 3, 11, "the nearest is \"repeat\""},
        Fault{"[displacement]\nscale = inf", "scene.range", 2, 9, "finite"},
        Fault{"[displacement]\nscale = nan", "scene.range", 2, 9, "finite"},
        Fault{"[displacement]\nscale = \"big\"", "scene.type", 2, 9, "a number is expected"},
        Fault{"[displacement]\nscale = 1e300", "scene.range", 2, 9, "finite"},
        Fault{"[camera]\nup = [0, 2, -2]", "scene.range", 2, 6, "parallel"},
        Fault{"[camera]\nup = [0, 0, 0]", "scene.range", 2, 6, "is 0; a direction"},
        Fault{"[camera]\ntarget = [0, -2, 2]", "scene.range", 2, 10, "target is its position"},
        Fault{"[camera]\nposition = [0, nan, 2]", "scene.range", 2, 12, "3 numbers, each a finite number"},
        Fault{"[camera]\nvertical_fov = 180", "scene.range", 2, 16, "between 0 and 180"},
        Fault{"[camera]\nnear = 0", "scene.range", 2, 8, "above 0"},
        Fault{"[camera]\nnear = 5\nfar = 5", "scene.range", 2, 8, "near below far"},
        Fault{"[light]\ncolor = [1, 1, 1]", "scene.type", 1, 1, "one or more [[light]]"},
        Fault{"[[light]]\ndirection = [0, 0, 0]", "scene.range", 2, 13, "direction towards the light"},
        Fault{"[[light]]\n[[light]]\ncolor = [1, -1, 1]", "scene.range", 3, 9, "light 2"},
        Fault{"[material]\nalbedo = [0, 2, 0]", "scene.range", 2, 10, "from 0 to 1"},
        Fault{"[material]\nshininess = 0", "scene.range", 2, 13, "above 0"},
        Fault{"[image]\nwidth = 8193", "scene.range", 2, 9, "from 1 to 8192"},
        Fault{"[image]\nheight = 0", "scene.range", 2, 10, "from 1 to 8192"},
        Fault{"[image\n", "scene.syntax", 1, 7, ""}));

TEST(Scene, MissingFileIsNamed) {
  const auto scene = load_scene("/no/such/scene.toml");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().id, "scene.missing");
  EXPECT_THAT(scene.error().message, HasSubstr("'scene.toml' does not exist"));
}

TEST(Scene, LoadsFromAFile) {
  const TemporaryFolder folder;
  const auto scene = load_scene(folder.write("s.toml", "[height_map]\npath = \"a.png\"\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->height_map.path, folder / "a.png");
  EXPECT_EQ(scene_height_map(*scene).error().id, "image.missing");
}

TEST(SceneMesh, GeneratesItsKindWithScaledUvs) {
  const auto scene = parse_scene(full_scene, "one.toml");
  const auto mesh = scene_mesh(*scene);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->name, "torus");
  EXPECT_EQ(mesh->triangles.size(), 24u * 12 * 2);
  EXPECT_EQ(mesh->uvs.back(), (std::array{4.0f, 2.5f}));
  EXPECT_EQ(split_normals(*mesh), 0u);
}

TEST(SceneMesh, FilesGoThroughTheLoader) {
  Scene scene;
  scene.mesh.kind = MeshKind::file;
  scene.mesh.path = "/m/x.3ds";
  EXPECT_EQ(scene_mesh(scene).error().id, "scene.mesh-loader");
  const MeshLoader loader = [](const std::filesystem::path&) -> Result<Mesh> {
    Mesh mesh = make_sphere(1, 8, 4);
    mesh.uvs.clear();
    mesh.normals.clear();
    return mesh;
  };
  EXPECT_EQ(scene_mesh(scene, loader).error().id, "mesh.uv");
  EXPECT_EQ(scene_mesh(scene, loader).error().file, "/m/x.3ds");
  scene.mesh.uv = UvSource::spherical;
  const auto mesh = scene_mesh(scene, loader);
  ASSERT_TRUE(mesh) << format(mesh.error());
  EXPECT_EQ(split_normals(*mesh), 0u);
  EXPECT_EQ(closedness_fault(*mesh), "");
}

}  // namespace
}  // namespace relievo::test
