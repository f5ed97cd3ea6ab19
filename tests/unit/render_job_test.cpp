// What an engine needs of a render Job besides the Job: the maps to bake, and the block to write when a camera moves.
#include "relievo/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace relievo {
namespace {

MapSet flat_maps() {
  return map_set(HeightMap{1, 1, {0.0f}, AddressMode::repeat});
}

RenderRequest request_of(const std::string& technique) {
  RenderRequest request;
  request.stage = "surface";
  request.technique = technique;
  return request;
}

/// As baked: present is all that making a Job asks of it.
void add_normal_map(MapSet& maps) {
  MapData& normal = maps["normal"];
  normal = maps.at("height");
  normal.name = "normal";
  normal.channels = 3;
  normal.texels = std::vector<float>{0, 0, 1};
}

float float_at(const std::vector<std::byte>& bytes, std::size_t offset) {
  float value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(RenderJob, RequiredMapsAreThoseOfTheStageAndTheTechnique) {
  const auto registry = load_registry();
  ASSERT_TRUE(registry);
  const auto maps = required_maps(*registry, "surface", "quadrant_maxima");
  ASSERT_TRUE(maps);
  for (const char* map : {"normal", "cell_corners", "quadrant_maxima"})
    EXPECT_NE(std::find(maps->begin(), maps->end(), map), maps->end()) << map;
  const auto unknown = required_maps(*registry, "surface", "quadrant_maximum");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().id, "describe.unknown-technique");
}

TEST(RenderJob, SceneBlockIsTheBufferOfTheJob) {
  const auto registry = load_registry();
  MapSet maps = flat_maps();
  add_normal_map(maps);
  const Scene scene;
  const auto job = make_render_job(*registry, scene, make_plane(), maps, request_of("relief"), "spirv");
  ASSERT_TRUE(job) << format(job.error());
  const auto block = scene_block(scene);
  ASSERT_TRUE(block);
  const auto buffer =
      std::find_if(job->buffers.begin(), job->buffers.end(), [](const Buffer& b) { return b.name == "Scene"; });
  ASSERT_NE(buffer, job->buffers.end());
  EXPECT_EQ(buffer->data, *block);
}

TEST(RenderJob, SceneBlockFollowsTheCamera) {
  constexpr std::size_t eye = 64;  // after the matrix
  Scene scene;
  scene.camera.position = {1, -2, 3};
  const auto block = scene_block(scene);
  ASSERT_TRUE(block);
  EXPECT_EQ(float_at(*block, eye), 1);
  EXPECT_EQ(float_at(*block, eye + 4), -2);
  EXPECT_EQ(float_at(*block, eye + 8), 3);
}

TEST(RenderJob, SceneBlockRefusesAFifthLight) {
  Scene scene;
  scene.lights.assign(4, SceneLight{});
  EXPECT_TRUE(scene_block(scene));
  scene.lights.emplace_back();
  const auto block = scene_block(scene);
  ASSERT_FALSE(block);
  EXPECT_EQ(block.error().id, "render.lights");
}

TEST(RenderJob, AMissingMapIsNamed) {
  const auto registry = load_registry();
  const auto job = make_render_job(*registry, Scene{}, make_plane(), flat_maps(), request_of("relief"), "spirv");
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().id, "render.missing-map");
  EXPECT_NE(job.error().message.find("'normal'"), std::string::npos) << job.error().message;
  const auto no_height = make_render_job(*registry, Scene{}, make_plane(), MapSet{}, request_of("relief"), "spirv");
  ASSERT_FALSE(no_height);
  EXPECT_EQ(no_height.error().id, "render.missing-map");
}

TEST(RenderJob, RequestsShareProgramsMapsMeshesAndDepth) {
  const auto registry = load_registry();
  MapSet maps = flat_maps();
  add_normal_map(maps);
  std::vector<RenderRequest> requests(3, request_of("relief"));
  requests[1].aov = Aov::uv;
  requests[2].values["surface.normal_source"] = 1;  // an axis: another program
  const std::vector<Mesh> meshes(2, make_plane());
  const auto job = make_render_job(*registry, Scene{}, meshes, maps, requests, "spirv");
  ASSERT_TRUE(job) << format(job.error());
  EXPECT_EQ(job->programs.size(), 3U);
  EXPECT_EQ(job->commands.size(), 6U);
  EXPECT_EQ(job->read_backs.size(), 6U);
  EXPECT_EQ(job->textures.size(), 2U + 1 + 6) << "height, normal, depth and what is drawn";
  std::set<int> vertices;
  for (const Command& command : job->commands) vertices.insert(std::get<Draw>(command).vertex_buffer);
  EXPECT_EQ(vertices.size(), 2U);
  EXPECT_EQ(std::count_if(job->buffers.begin(), job->buffers.end(), [](const Buffer& b) { return b.name == "Scene"; }),
            1)
      << "which an engine writes anew when its camera moves";
  const auto alone = make_render_job(*registry, Scene{}, make_plane(), maps, requests[0], "spirv");
  ASSERT_TRUE(alone);
  EXPECT_EQ(job->name, alone->name + " and 2 more");
  const auto twice = make_render_job(*registry, Scene{}, meshes, maps, std::vector(2, requests[0]), "spirv");
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->programs.size(), 1U);
}

/// Many devices cannot filter 32-bit floats.
TEST(RenderJob, OnlyWhatIsSampledIsFiltered) {
  const auto registry = load_registry();
  MapSet maps = flat_maps();
  add_normal_map(maps);
  const auto filter_of = [&](const RenderRequest& request, const std::string& map) {
    const auto job = make_render_job(*registry, Scene{}, make_plane(), maps, request, "spirv");
    EXPECT_TRUE(job) << format(job.error());
    const auto found =
        std::find_if(job->textures.begin(), job->textures.end(), [&](const Texture& one) { return one.name == map; });
    return found->sampler.min_mag;
  };
  RenderRequest request = request_of("relief");
  request.filter = HeightFilter::exact;
  EXPECT_EQ(filter_of(request, "height"), TexelFilter::nearest);
  EXPECT_EQ(filter_of(request, "normal"), TexelFilter::linear);
  request.filter = HeightFilter::hardware;
  EXPECT_EQ(filter_of(request, "height"), TexelFilter::linear);
  request.aov = Aov::uv;
  EXPECT_EQ(filter_of(request, "normal"), TexelFilter::nearest) << "a uv needs no normal";
}

TEST(RenderJob, NoRequestsAreAJobThatDoesNothing) {
  const auto registry = load_registry();
  const auto job =
      make_render_job(*registry, Scene{}, std::vector<Mesh>(1), flat_maps(), std::span<const RenderRequest>{}, "spirv");
  ASSERT_TRUE(job) << format(job.error());
  EXPECT_TRUE(job->commands.empty());
  EXPECT_TRUE(validate_job(*job));
}

TEST(RenderJob, AMapThatAnAxisRulesOutIsNotAskedFor) {
  const auto registry = load_registry();
  RenderRequest request = request_of("relief");
  request.values["surface.normal_source"] = 1;  // height
  const auto job = make_render_job(*registry, Scene{}, make_plane(), flat_maps(), request, "spirv");
  EXPECT_TRUE(job) << format(job.error());
}

}  // namespace
}  // namespace relievo
