/// Adding a technique touches one new folder: the template, copied into a fresh one, runs everywhere a technique runs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/gl_compiler.hpp"
#include "support/height_maps.hpp"
#include "support/linear_claims.hpp"
#include "support/pipeline.hpp"
#include "support/scenes.hpp"
#include "support/target_checks.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

const fs::path source = RELIEVO_SOURCE_DIR;
const fs::path template_folder = source / "tests/support/template_technique";

/// Path → size and content hash of every file below the folders that hold the project's sources.
std::map<std::string, std::uint64_t> tree_hash(const fs::path& root = source) {
  std::map<std::string, std::uint64_t> hashes;
  for (const char* folder : {"sdk", "backends", "techniques", "shaders", "tests", "docs", "examples", "cmake"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string content = TemporaryFolder::read(entry.path());
      hashes[fs::relative(entry.path(), root).string()] = std::hash<std::string>()(content);
    }
  }
  return hashes;
}

/// A fresh folder that holds the template, and nothing else; the sources must be the same before and after.
class TemplateTechnique : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = tree_hash();
    fs::copy(template_folder, folder_ / "template_technique", fs::copy_options::recursive);
    Result<Registry> loaded = load_registry({folder_.path()});
    ASSERT_TRUE(loaded) << format(loaded.error());
    registry_ = std::move(*loaded);
  }
  void TearDown() override { EXPECT_TRUE(tree_hash() == before_) << "a file of the source tree changed"; }

  TemporaryFolder folder_;
  Registry registry_;

 private:
  std::map<std::string, std::uint64_t> before_;
};

TEST_F(TemplateTechnique, IsFoundBesideOurOwn) {
  ASSERT_TRUE(registry_.techniques.contains("template_technique"));
  ASSERT_TRUE(registry_.maps.contains("template_slope"));
  EXPECT_EQ(registry_.techniques.size(), registry().techniques.size() + 1);
  EXPECT_FALSE(registry().techniques.contains("template_technique"));
}

TEST_F(TemplateTechnique, CompilesInEveryStageForEveryTarget) {
  int compiled_for = 0, refused = 0;
  for (const auto& [name, stage] : registry_.stages) {
    if (stage.roles.empty()) continue;
    Permutation permutation;
    permutation.stage = name;
    for (const std::string& role : stage.roles) permutation.roles[role] = "template_technique";
    const auto composed = compose(registry_, permutation);
    ASSERT_TRUE(composed) << format(composed.error());
    for (const Target& target : all_targets()) {
      const auto compiled = compile(*composed, {&target, 1}, {}, stage.fallback);
      if (!check_capabilities(target, *composed, stage.fallback)) {
        EXPECT_FALSE(compiled);
        ++refused;
        continue;
      }
      ASSERT_TRUE(compiled) << to_string(target) << " " << format(compiled.error());
      EXPECT_EQ(relievo::testing::check_program(*compiled), "") << name << " " << to_string(target);
      ++compiled_for;
    }
  }
  EXPECT_GE(compiled_for, 8 + 10 + 5) << "ray, surface, prism";
  EXPECT_GE(refused, 2 + 5);
}

TEST_F(TemplateTechnique, TracesOnBothBackendsWithItsOwnMap) {
  const HeightMap map = smooth_noise_map(33, 20);
  const std::vector<Ray> rays = bounded_rays(map, 300, 21);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  const TraceRequest request = request_of("template_technique", {{"template_technique.steps", 512}});
  for (const std::string& name : both_backends) {
    MapSet maps = map_set(map);
    std::vector<std::string> messages;
    const auto traced = trace(backend(name), registry_, maps, rays, {&request, 1}, {}, &messages);
    ASSERT_TRUE(traced) << format(traced.error());
    EXPECT_THAT(messages, ::testing::IsEmpty());
    EXPECT_TRUE(maps.contains("template_slope")) << "its map is baked without a line of C++";
    const ErrorFigures figures = compare_hits(truth, traced->front().hits, map.width, map.height);
    EXPECT_LT(figures.wrong_percent(), 1.0) << name;
    EXPECT_GT(figures.judged, 250U);
    const auto biased =
        trace_on(name, map, rays, request_of("template_technique", {{"template_technique.bias", 0.5}}), registry_);
    EXPECT_GT(compare_hits(truth, biased, map.width, map.height).wrong_percent(), 5) << "its parameter does nothing";
  }
}

TEST_F(TemplateTechnique, RendersOnBothBackends) {
  const Scene scene = make_scene(MeshKind::torus, 64);
  for (const char* stage : {"surface", "prism"}) {
    RenderRequest request;
    request.stage = stage;
    request.technique = "template_technique";
    const auto vulkan = render_on("vulkan", scene, mesh_of(scene), smooth_noise_map(32, 32), request, registry_);
    const auto opengl = render_on("opengl", scene, mesh_of(scene), smooth_noise_map(32, 32), request, registry_);
    EXPECT_GE(compare_images(vulkan.color, opengl.color).within_percent, 99.5) << stage;
  }
}

/// The program on the folder, by the option that each command has.
TEST_F(TemplateTechnique, RunsThroughTheProgram) {
  const std::string folder = folder_.path().string(), height = (folder_ / "height.pfm").string();
  const HeightMap map = smooth_noise_map(33, 20);
  ASSERT_TRUE(write_pfm(height, Image{map.width, map.height, 1, map.texels}));
  folder_.write("rays.csv", "u,v,h,du,dv,dh\n0.1,0.2,1,0.3,0.1,-1\n0.5,0.5,1,0,0,-1\n");
  const auto run = [&](std::vector<std::string> arguments) {
    const ChildResult result = run_relievo(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[0] << ": " << result.err << result.out;
    return result.out;
  };
  for (const char* option : {"--techniques", "--techniques-dir", "-I"}) {
    EXPECT_NE(run({"list", option, folder, "techniques"}).find("template_technique"), std::string::npos) << option;
  }
  EXPECT_NE(run({"describe", "--techniques", folder, "template_technique"}).find("A technique to start from"),
            std::string::npos);
  run({"compile", "template_technique", "--techniques", folder, "--stage", "surface", "--target", "all", "-o",
       (folder_ / "compiled").string()});
  EXPECT_TRUE(fs::exists(folder_ / "compiled/template_technique.surface.frag.hlsl-5.0.hlsl"));
  run({"bake", "template_slope", "--techniques", folder, "--height", height, "-o", (folder_ / "slope.pfm").string()});
  EXPECT_TRUE(load_image(folder_ / "slope.pfm"));
  for (const std::string& name : both_backends) {
    const std::string hits = run({"trace", "--technique", "template_technique", "--techniques", folder, "--height",
                                  height, "--rays", (folder_ / "rays.csv").string(), "--backend", name});
    EXPECT_EQ(std::count(hits.begin(), hits.end(), '\n'), 3) << hits;
    EXPECT_NE(hits.find("\nhit,"), std::string::npos) << hits;
  }
  folder_.write("scene.toml", "[image]\nwidth = 48\nheight = 32\n");
  run({"render", (folder_ / "scene.toml").string(), "--technique", "template_technique", "--techniques", folder, "-o",
       (folder_ / "picture.png").string()});
  EXPECT_TRUE(load_image(folder_ / "picture.png"));
  const auto rows = nlohmann::json::parse(
      run({"bench", "--techniques", "relief,template_technique", "--techniques-dir", folder, "--height", height,
           "--rays", (folder_ / "rays.csv").string(), "--repeat", "1", "--json"}),
      nullptr, false);
  ASSERT_TRUE(rows.is_array() && rows.size() == 2) << rows.dump();
  EXPECT_EQ(rows[1]["technique"], "template_technique");
}

/// A fault that the tree hash must see.
TEST(TreeHash, SeesAChangedAnAddedAndARemovedFile) {
  const TemporaryFolder root;
  fs::create_directories(root / "sdk");
  root.write("sdk/a.cpp", "1");
  const auto first = tree_hash(root.path());
  EXPECT_EQ(first.size(), 1U);
  root.write("sdk/a.cpp", "2");
  EXPECT_NE(tree_hash(root.path()), first);
  root.write("sdk/a.cpp", "1");
  EXPECT_EQ(tree_hash(root.path()), first);
  root.write("sdk/b.cpp", "1");
  EXPECT_NE(tree_hash(root.path()), first);
  fs::remove(root / "sdk/b.cpp");
  fs::remove(root / "sdk/a.cpp");
  EXPECT_NE(tree_hash(root.path()), first);
  EXPECT_GT(tree_hash().size(), 200U) << "the project's own tree is hashed";
}

}  // namespace
}  // namespace relievo::test
