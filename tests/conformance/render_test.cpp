/// Pictures of the drawing stages: both backends, the oracle, the finely displaced mesh, and meshes that are no good.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/height_maps.hpp"
#include "support/pipeline.hpp"
#include "support/scenes.hpp"

namespace relievo::test {
namespace {

using Pixels = std::vector<std::uint8_t>;

/// The stages that draw, each with a technique where it traces.
std::vector<std::pair<std::string, std::string>> drawing_cases() {
  return {{"surface", "relief"}, {"vertex", ""}, {"prism", "relief"}};
}

HeightMap hills() {
  return smooth_noise_map(48, 32);
}

std::size_t drawn(const Pixels& pixels) {
  std::size_t count = 0;
  for (std::size_t i = 3; i < pixels.size(); i += 4) count += pixels[i] > 0;
  return count;
}

/// The rule for pictures of two backends: within 1/255 on 99.9 % of the pixels. The rest are edges, where two compilers
/// may round a coordinate to either side of a triangle.
bool pictures_agree(const Pixels& a, const Pixels& b) {
  return compare_images(a, b).within_percent >= 99.9;
}

void expect_finite(const RenderResult& result, const std::string& what) {
  for (const float value : result.image.pixels) ASSERT_TRUE(std::isfinite(value)) << what;
}

TEST(Render, PicturesOfBothBackendsAgree) {
  for (const MeshKind kind : {MeshKind::plane, MeshKind::torus}) {
    const Scene scene = make_scene(kind);
    const Mesh mesh = mesh_of(scene);
    for (const auto& [stage, technique] : drawing_cases()) {
      const auto vulkan = render_on("vulkan", scene, mesh, hills(), request_of(stage, technique));
      const auto opengl = render_on("opengl", scene, mesh, hills(), request_of(stage, technique));
      const ImageDifference difference = compare_images(vulkan.color, opengl.color);
      EXPECT_TRUE(pictures_agree(vulkan.color, opengl.color))
          << stage << " on " << to_string(kind) << ": " << difference.within_percent << " % within 1/255";
      EXPECT_GT(drawn(vulkan.color), 3000U) << stage << ": next to nothing is drawn";
    }
  }
}

TEST(Render, EveryStageDrawsMuchTheSameWithLooseArithmetic) {
  const Scene scene = make_scene(MeshKind::torus);
  const Mesh mesh = mesh_of(scene);
  for (const auto& [stage, technique] : drawing_cases()) {
    const auto exact = render_on("vulkan", scene, mesh, hills(), request_of(stage, technique));
    const auto loose = render_on("vulkan_loose", scene, mesh, hills(), request_of(stage, technique));
    EXPECT_GT(compare_images(exact.color, loose.color).within_percent, 99.5) << stage;
  }
}

TEST(Render, TheSameComparisonCatchesSeededFaults) {
  const Scene scene = make_scene(MeshKind::torus);
  const Pixels good = render_on("vulkan", scene, mesh_of(scene), hills(), request_of("prism", "relief")).color;
  ASSERT_TRUE(pictures_agree(good, good));
  Pixels brighter = good, swapped = good, flipped = good;
  for (std::size_t i = 0; i < brighter.size(); ++i) {
    if (i % 4 != 3 && good[i / 4 * 4 + 3] > 0) brighter[i] = static_cast<std::uint8_t>(std::min(good[i] + 2, 255));
  }
  EXPECT_FALSE(pictures_agree(good, brighter)) << "2/255 on every drawn pixel";
  const auto row = static_cast<std::ptrdiff_t>(4 * scene.image.width);
  const auto middle = row * (scene.image.height / 2);
  std::swap_ranges(swapped.begin() + middle, swapped.begin() + middle + row, swapped.begin() + middle + 12 * row);
  EXPECT_FALSE(pictures_agree(good, swapped)) << "two rows swapped";
  for (int y = 0; y < scene.image.height / 2; ++y) {
    std::swap_ranges(flipped.begin() + y * row, flipped.begin() + (y + 1) * row,
                     flipped.begin() + (scene.image.height - 1 - y) * row);
  }
  EXPECT_FALSE(pictures_agree(good, flipped)) << "upside down";
}

TEST(Render, AFaultInTheHeightMapIsSeenInThePicture) {
  const Scene scene = make_scene(MeshKind::plane);
  HeightMap shifted = hills();
  std::rotate(shifted.texels.begin(), shifted.texels.begin() + 1, shifted.texels.end());
  const auto good = render_on("vulkan", scene, mesh_of(scene), hills(), request_of("surface", "relief"));
  const auto bad = render_on("vulkan", scene, mesh_of(scene), shifted, request_of("surface", "relief"));
  EXPECT_FALSE(pictures_agree(good.color, bad.color));
}

TEST(Render, ThreeRunsAreByteIdentical) {
  const Scene scene = make_scene(MeshKind::sphere, 96);
  const Mesh mesh = mesh_of(scene);
  for (const std::string& name : both_backends) {
    for (const auto& [stage, technique] : drawing_cases()) {
      const auto first = render_on(name, scene, mesh, hills(), request_of(stage, technique));
      for (int run = 0; run < 2; ++run)
        EXPECT_EQ(render_on(name, scene, mesh, hills(), request_of(stage, technique)).color, first.color)
            << stage << " on " << name;
    }
  }
}

TEST(Render, PrismsHaveTheSilhouetteOfTheDisplacedMeshAndNoCracks) {
  for (const MeshKind kind : {MeshKind::sphere, MeshKind::torus}) {
    const Scene scene = make_scene(kind, 200);
    const Mesh mesh = mesh_of(scene);
    for (const std::string& name : both_backends) {
      const Pixels reference = render_on(name, scene, mesh, hills(), request_of("vertex", "")).color;
      for (const std::uint64_t seed : {1, 2, 3}) {
        const Pixels prism = render_on(name, scene, shuffle(mesh, seed), hills(), request_of("prism", "relief")).color;
        const std::string what = fmt::format("{} on {}, seed {}", to_string(kind), name, seed);
        EXPECT_GE(compare_images(prism, reference).mask_iou, 0.99) << what;
        EXPECT_EQ(count_cracks(prism, reference, scene.image.width, scene.image.height), 0U) << what;
      }
    }
  }
}

/// The oracle's hits belong to a mesh; the others share one Job.
TEST(Render, SeveralMeshesGiveThePicturesThatEachGives) {
  const Scene scene = make_scene(MeshKind::torus);
  const std::vector<Mesh> meshes = {mesh_of(scene), make_plane()};
  for (const char* technique : {"relief", "oracle"}) {
    MapSet maps = map_set(hills());
    const RenderRequest request = request_of("prism", technique);
    const auto together = render(backend("vulkan"), registry(), scene, std::span(meshes), maps, {&request, 1});
    ASSERT_TRUE(together) << format(together.error());
    ASSERT_EQ(together->size(), 2U);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ((*together)[k].color, render_on("vulkan", scene, meshes[k], hills(), request).color) << technique << k;
    EXPECT_NE((*together)[0].color, (*together)[1].color) << technique;
  }
}

/// Stages, techniques and what is shown in one list: each picture is where its request is.
TEST(Render, SeveralRequestsGiveThePicturesThatEachGives) {
  const Scene scene = make_scene(MeshKind::torus, 64);
  const std::vector<Mesh> meshes = {mesh_of(scene), make_plane()};
  const std::vector<RenderRequest> requests = {
      request_of("prism", "oracle"),   request_of("surface", "relief"),        request_of("vertex", ""),
      request_of("surface", "oracle"), request_of("prism", "relief", Aov::uv), request_of("prism", "oracle", Aov::uv)};
  for (const std::string& name : both_backends) {
    MapSet maps = map_set(hills());
    const auto together = render(backend(name), registry(), scene, meshes, maps, requests);
    ASSERT_TRUE(together) << format(together.error());
    ASSERT_EQ(together->size(), meshes.size() * requests.size());
    for (std::size_t i = 0; i < together->size(); ++i) {
      const RenderRequest& request = requests[i % requests.size()];
      const RenderResult alone = render_on(name, scene, meshes[i / requests.size()], hills(), request);
      EXPECT_EQ((*together)[i].image.pixels, alone.image.pixels)
          << fmt::format("{} of {} on {}, mesh {}", request.technique, request.stage, name, i / requests.size());
      EXPECT_GT(std::count_if(alone.image.pixels.begin(), alone.image.pixels.end(), [](float x) { return x > 0; }), 99);
    }
  }
}

/// Hits of the oracle are replayed only where they are the same.
TEST(Render, OracleRequestsOfOtherValuesHaveHitsOfTheirOwn) {
  const Scene scene = make_scene(MeshKind::plane, 64);
  const Mesh mesh = mesh_of(scene);
  std::vector<RenderRequest> requests(2, request_of("surface", "oracle"));
  requests[1].values["surface.normal_source"] = 1;
  MapSet maps = map_set(hills());
  const auto together = render(backend("vulkan"), registry(), scene, {&mesh, 1}, maps, requests);
  ASSERT_TRUE(together) << format(together.error());
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ((*together)[k].color, render_on("vulkan", scene, mesh, hills(), requests[k]).color) << k;
  EXPECT_NE((*together)[0].color, (*together)[1].color);
}

TEST(Render, CountCracksCatchesOnePixel) {
  const Scene scene = make_scene(MeshKind::sphere, 96);
  const Pixels good = render_on("vulkan", scene, mesh_of(scene), hills(), request_of("prism", "relief")).color;
  ASSERT_EQ(count_cracks(good, good, 96, 96), 0U);
  Pixels cracked = good;
  const std::size_t middle = 4 * (48 * 96 + 48);
  ASSERT_GT(good[middle + 3], 0);
  for (std::size_t c = 0; c < 4; ++c) cracked[middle + c] = 0;
  EXPECT_EQ(count_cracks(cracked, good, 96, 96), 1U);
}

/// Triangles that do not share their edges leave gaps in an open mesh, and the count sees them.
TEST(Render, CountCracksCatchesTornPrisms) {
  const Scene scene = make_scene(MeshKind::plane, 200);
  const Mesh whole = subdivide(mesh_of(scene), 4);
  Mesh torn{"torn", {}, {}, {}, {}};
  for (const auto& triangle : whole.triangles) {
    const auto first = static_cast<std::uint32_t>(torn.positions.size());
    for (const std::uint32_t corner : triangle) {
      std::array<float, 3> position{};
      for (std::size_t c = 0; c < 3; ++c) {
        float middle = 0;
        for (const std::uint32_t other : triangle) middle += whole.positions[other][c] / 3;
        position[c] = middle + 0.9f * (whole.positions[corner][c] - middle);
      }
      torn.positions.push_back(position);
      torn.normals.push_back(whole.normals[corner]);
      torn.uvs.push_back(whole.uvs[corner]);
    }
    torn.triangles.push_back({first, first + 1, first + 2});
  }
  const HeightMap map = constant_map(8, 8, 0.5);
  const Pixels reference = render_on("vulkan", scene, whole, map, request_of("vertex", "")).color;
  EXPECT_EQ(
      count_cracks(render_on("vulkan", scene, whole, map, request_of("prism", "relief")).color, reference, 200, 200),
      0U);
  EXPECT_GT(
      count_cracks(render_on("vulkan", scene, torn, map, request_of("prism", "relief")).color, reference, 200, 200),
      0U);
}

TEST(Render, AFineLinearSearchDrawsWhatTheOracleReplays) {
  const Scene scene = make_scene(MeshKind::plane);
  const Mesh mesh = mesh_of(scene);
  for (const std::string& name : both_backends) {
    RenderRequest fine = request_of("surface", "linear_search");
    fine.values["linear_search.steps"] = 4096;
    const auto searched = render_on(name, scene, mesh, hills(), fine);
    const auto oracle = render_on(name, scene, mesh, hills(), request_of("surface", "oracle"));
    const ImageDifference difference = compare_images(searched.color, oracle.color);
    // A step is 1/4096 of the way, under a 50th of a texel: shading then differs by less than 1/255 but where a ray
    // touches a hill and passes (silhouettes within the plane).
    EXPECT_GE(difference.within_percent, 99.5) << name;
    EXPECT_GE(difference.mask_iou, 0.999) << name;
    RenderRequest coarse = fine;
    coarse.values["linear_search.steps"] = 4;
    EXPECT_LT(compare_images(render_on(name, scene, mesh, hills(), coarse).color, oracle.color).within_percent, 99.5)
        << name << ": four steps must be seen";
  }
}

TEST(Render, TheStatusOfTheOraclesPixelsIsTheTechniques) {
  Scene scene = make_scene(MeshKind::plane, 96);
  scene.displacement.bias = -scene.displacement.scale;  // the relief lies below the square: rays leave by its edge
  const Mesh mesh = mesh_of(scene);
  const HeightMap map = with_address(hills(), AddressMode::clip);
  RenderRequest fine = request_of("surface", "relief", Aov::status);
  fine.values["relief.linear_steps"] = 2048;
  const auto searched = render_on("vulkan", scene, mesh, map, fine);
  const auto oracle = render_on("vulkan", scene, mesh, map, request_of("surface", "oracle", Aov::status));
  std::size_t same = 0, pixels = searched.image.pixels.size() / 4, outside = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    same += searched.image.pixels[4 * i] == oracle.image.pixels[4 * i];
    outside +=
        oracle.image.pixels[4 * i + 3] > 0 && oracle.image.pixels[4 * i] == static_cast<float>(HitStatus::outside);
  }
  EXPECT_GE(static_cast<double>(same), 0.999 * static_cast<double>(pixels));
  EXPECT_GT(outside, 0U) << "no ray leaves the clip map: the case shows nothing";
}

/// Meshes and displacements that break frames: nothing may crash, complain or write NaN.
struct HardCase {
  std::string name;
  Scene scene;
  Mesh mesh;
};

/// A triangle of no area, one whose corners share a texture coordinate, a mirrored and a sheared one.
Mesh awkward_mesh() {
  Mesh mesh = make_plane();
  const auto add = [&](std::array<std::array<float, 3>, 3> positions, std::array<std::array<float, 2>, 3> uvs) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
    mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
    mesh.normals.insert(mesh.normals.end(), 3, {0, 0, 1});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  add({{{0, 0, 0.3f}, {0.5f, 0, 0.3f}, {1, 0, 0.3f}}}, {{{0, 0}, {0.5f, 0}, {1, 0}}});  // no area
  add({{{0, 0, 0.3f}, {0, 0, 0.3f}, {0, 0, 0.3f}}}, {{{0, 0}, {1, 0}, {0, 1}}});        // a point
  add({{{-1, -1, 0.2f}, {-0.5f, -1, 0.2f}, {-1, -0.5f, 0.2f}}}, {{{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}}});
  add({{{0.5f, 0.5f, 0.2f}, {1, 0.5f, 0.2f}, {0.5f, 1, 0.2f}}}, {{{1, 0}, {0, 0}, {1, 1}}});        // mirrored
  add({{{-1, 0.5f, 0.2f}, {-0.5f, 0.5f, 0.2f}, {-1, 1, 0.2f}}}, {{{0, 0}, {1, 0.9f}, {0.8f, 1}}});  // sheared
  return mesh;
}

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  const Scene plane = make_scene(MeshKind::plane, 64), torus = make_scene(MeshKind::torus, 64);
  const auto with = [](Scene scene, float scale, float bias = 0) {
    scene.displacement.scale = scale;
    scene.displacement.bias = bias;
    return scene;
  };
  cases.push_back({"scale 0", with(torus, 0), mesh_of(torus)});
  cases.push_back({"scale 0 with a bias", with(torus, 0, 0.1f), mesh_of(torus)});
  cases.push_back({"scale negative", with(torus, -0.1f), mesh_of(torus)});
  cases.push_back({"scale huge", with(torus, 1e6f), mesh_of(torus)});
  cases.push_back({"scale tiny", with(torus, 1e-30f), mesh_of(torus)});
  cases.push_back({"bias", with(torus, 0.1f, -0.05f), mesh_of(torus)});
  cases.push_back({"awkward triangles", plane, awkward_mesh()});
  Scene frame = plane;
  frame.displacement.units = DisplacementUnits::frame;
  cases.push_back({"awkward triangles, scale in frames", frame, awkward_mesh()});
  Scene within = make_scene(MeshKind::sphere, 64, 0.5f);
  within.camera.position = {0, -1.25f, 0.1f};
  within.camera.near_plane = 0.001f;
  cases.push_back({"camera within the shell", within, mesh_of(within)});
  Scene on_surface = within;
  on_surface.camera.position = {0, -1.0f, 0};
  cases.push_back({"camera on the base", on_surface, mesh_of(on_surface)});
  Scene behind = plane;
  behind.camera.position = {0.3f, -2, -1};
  cases.push_back({"seen from below", behind, mesh_of(plane)});
  Scene edge_on = plane;
  edge_on.camera.position = {0, -3, 0};
  cases.push_back({"seen edge on", edge_on, mesh_of(plane)});
  return cases;
}

TEST(Render, HardCasesGiveFiniteNumbersInEveryStage) {
  for (const auto& [name, scene, mesh] : hard_cases()) {
    for (const auto& [stage, technique] : drawing_cases()) {
      for (const Aov aov : {Aov::color, Aov::depth, Aov::normal, Aov::uv, Aov::status}) {
        const std::string backend = aov == Aov::depth ? "opengl" : "vulkan";
        const auto result = render_on(backend, scene, mesh, hills(), request_of(stage, technique, aov));
        expect_finite(result, fmt::format("{} {} {} on {}", name, stage, to_string(aov), backend));
      }
    }
  }
}

TEST(Render, HardCasesLookTheSameOnBothBackends) {
  for (const auto& [name, scene, mesh] : hard_cases()) {
    if (name == "scale huge" || name == "scale tiny" || name == "seen edge on") continue;  // rounding decides there
    for (const auto& [stage, technique] : drawing_cases()) {
      const auto vulkan = render_on("vulkan", scene, mesh, hills(), request_of(stage, technique));
      const auto opengl = render_on("opengl", scene, mesh, hills(), request_of(stage, technique));
      // Small pictures: 64² has 4 pixels in 0.1 %.
      EXPECT_GE(compare_images(vulkan.color, opengl.color).within_percent, 99.8) << name << " " << stage;
    }
  }
}

TEST(Render, DegenerateTrianglesAreCountedAndDrawnUndisplaced) {
  const Scene scene = make_scene(MeshKind::plane, 64);
  const auto result = render_on("vulkan", scene, awkward_mesh(), hills(), request_of("surface", "relief"));
  EXPECT_EQ(result.degenerate_triangles, 3U);
  EXPECT_EQ(render_on("vulkan", scene, make_plane(), hills(), request_of("surface", "relief")).degenerate_triangles,
            0U);
}

TEST(Render, DepthIsThatOfTheDisplacedMesh) {
  const Scene scene = make_scene(MeshKind::torus, 128);
  const Mesh mesh = mesh_of(scene);
  RenderRequest fine = request_of("prism", "relief", Aov::depth);
  fine.values["relief.linear_steps"] = 400;
  fine.values["relief.binary_steps"] = 16;
  const auto prism = render_on("vulkan", scene, mesh, hills(), fine);
  const auto vertex = render_on("vulkan", scene, mesh, hills(), request_of("vertex", "", Aov::depth));
  std::size_t both = 0, near = 0;
  for (std::size_t i = 0; i < prism.image.pixels.size(); i += 4) {
    if (prism.image.pixels[i + 3] == 0 || vertex.image.pixels[i + 3] == 0) continue;
    ++both;
    // Depths lie between 0.95 and 0.98 here; a tenth of the relief is about 2e-4 of depth.
    near += std::abs(prism.image.pixels[i] - vertex.image.pixels[i]) < 2e-4f;
  }
  EXPECT_GT(both, 2000U);
  EXPECT_GE(static_cast<double>(near), 0.97 * static_cast<double>(both)) << "edges of the picture's own relief aside";
}

}  // namespace
}  // namespace relievo::test
