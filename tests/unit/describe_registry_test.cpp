#include <gtest/gtest.h>

#include <algorithm>

#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

using examples::with;

/// The tree with `text` at `path`.
SourceTree tree_with(const std::string& path, std::string text) {
  SourceTree tree = examples::tree();
  tree[path] = std::move(text);
  return tree;
}

void expect_rejected(SourceTree tree, const std::string& file, std::string_view id, int line, int column,
                     std::string_view words) {
  const auto registry = load_registry(std::move(tree));
  ASSERT_FALSE(registry);
  EXPECT_EQ(registry.error().file, file);
  EXPECT_EQ(registry.error().code, ErrorCode::descriptor);
  examples::expect_error(registry.error(), id, line, column, words);
}

TEST(LoadRegistry, FindsDescriptorsByScanning) {
  const auto registry = load_registry(examples::tree());
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->techniques.size(), 1u);
  EXPECT_EQ(registry->maps.size(), 2u);
  EXPECT_EQ(registry->stages.size(), 1u);
  EXPECT_EQ(registry->sources.size(), examples::tree().size());
  EXPECT_EQ(registry->techniques.at("relief").file, "techniques/relief/technique.toml");
}

TEST(LoadRegistry, FindsAMapInsideATechnique) {
  SourceTree tree = examples::tree();
  tree["techniques/relief/maps/own/map.toml"] = R"(schema = 1
name = "own"
title = "Its own"
inputs = ["height"]
channels = 1
sampler = "own_map"
binding = {set = 1, binding = 7}
module = "own.glsl"
)";
  tree["techniques/relief/maps/own/own.glsl"] = "";
  const auto registry = load_registry(std::move(tree));
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->maps.at("own").module, "techniques/relief/maps/own/own.glsl");
}

TEST(LoadRegistry, HoldsEveryEmbeddedDescriptor) {
  const auto registry = load_registry();
  ASSERT_TRUE(registry) << format(registry.error());
  const auto is_descriptor = [](const auto& source) {
    return source.first.ends_with("/technique.toml") || source.first.ends_with("/map.toml") ||
           source.first.ends_with("/stage.toml");
  };
  const auto descriptors = std::count_if(embedded_sources().begin(), embedded_sources().end(), is_descriptor);
  EXPECT_EQ(registry->techniques.size() + registry->maps.size() + registry->stages.size(),
            static_cast<std::size_t>(descriptors));
  EXPECT_TRUE(registry->origins.empty());
}

TEST(LoadRegistry, EmbeddedDescriptorsSayWhatTheyAre) {
  const auto registry = load_registry();
  ASSERT_TRUE(registry);
  for (const auto& [name, technique] : registry->techniques) {
    EXPECT_FALSE(technique.summary.empty()) << name;
    EXPECT_FALSE(technique.source.empty()) << name;
  }
  for (const auto& [name, stage] : registry->stages) EXPECT_FALSE(stage.summary.empty()) << name;
  for (const auto& [name, map] : registry->maps) EXPECT_FALSE(map.summary.empty()) << name;
}

TEST(LoadRegistry, NamesTheFileOfAParseError) {
  const std::string path = "techniques/relief/technique.toml";
  expect_rejected(tree_with(path, with(examples::technique, "title =", "tittle =")), path, "describe.unknown-key", 3, 1,
                  "tittle");
}

TEST(LoadRegistry, RejectsAModuleThatDoesNotExist) {
  SourceTree tree = examples::tree();
  tree.erase("techniques/relief/relief.glsl");
  tree["techniques/relief/releif.glsl"] = "";
  expect_rejected(tree, "techniques/relief/technique.toml", "describe.missing-file", 8, 10,
                  "the nearest is \"techniques/relief/releif.glsl\"");
  for (const char* file :
       {"shaders/maps/normal/bake.glsl", "shaders/maps/normal/normal.glsl", "shaders/stages/prism/prism.geom.glsl"}) {
    SourceTree broken = examples::tree();
    ASSERT_EQ(broken.erase(file), 1u);
    const auto registry = load_registry(std::move(broken));
    ASSERT_FALSE(registry) << file;
    EXPECT_EQ(registry.error().id, "describe.missing-file");
    EXPECT_NE(registry.error().message.find(file), std::string::npos);
    EXPECT_GT(registry.error().line, 1);
  }
}

TEST(LoadRegistry, RejectsMapsThatNobodyProvides) {
  expect_rejected(tree_with("techniques/relief/technique.toml",
                            with(examples::technique, "[\"height\"]", "[\"normal\", \"hight\"]")),
                  "techniques/relief/technique.toml", "describe.unknown-map", 9, 19,
                  R"("hight", which nobody provides; the nearest is "height")");
  expect_rejected(tree_with("shaders/stages/prism/stage.toml", with(examples::stage, "[\"normal\"]", "[\"normals\"]")),
                  "shaders/stages/prism/stage.toml", "describe.unknown-map", 5, 9, R"(the nearest is "normal")");
  expect_rejected(tree_with("shaders/maps/normal/map.toml", with(examples::map, "[\"height\"]", "[\"depths\"]")),
                  "shaders/maps/normal/map.toml", "describe.unknown-map", 4, 11, "known are height, normal");
}

TEST(LoadRegistry, RejectsANameTakenTwice) {
  expect_rejected(tree_with("other/relief/technique.toml", std::string(examples::technique)),
                  "techniques/relief/technique.toml", "describe.duplicate", 2, 8, "other/relief/technique.toml");
}

TEST(LoadRegistry, RejectsTwoMapsAtOneBinding) {
  expect_rejected(tree_with("shaders/maps/normal/map.toml", with(examples::map, "binding = 1}", "binding = 0}")),
                  "shaders/maps/normal/map.toml", "describe.binding-collision", 7, 11, "set 1, binding 0");
  expect_rejected(
      tree_with("shaders/maps/normal/map.toml", with(examples::map, "relievo_normal_map", "relievo_height_map")),
      "shaders/maps/normal/map.toml", "describe.binding-collision", 6, 11, "relievo_height_map");
}

TEST(LoadRegistry, AllowsOneBindingInTwoSets) {
  const auto registry = load_registry(tree_with(
      "shaders/maps/normal/map.toml", with(examples::map, "{set = 1, binding = 1}", "{set = 2, binding = 0}")));
  EXPECT_TRUE(registry) << format(registry.error());
}

TEST(LoadRegistry, RejectsMapsThatNeedEachOther) {
  expect_rejected(tree_with("shaders/maps/normal/map.toml", with(examples::map, "[\"height\"]", "[\"normal\"]")),
                  "shaders/maps/normal/map.toml", "describe.cycle", 4, 11, "normal → normal");
  SourceTree tree =
      tree_with("shaders/maps/normal/map.toml", with(examples::map, "[\"height\"]", "[\"height\", \"cone\"]"));
  std::string cone = with(examples::map, "name = \"normal\"", "name = \"cone\"");
  cone = with(with(with(cone, "[\"height\"]", "[\"normal\"]"), "relievo_normal_map", "cone_map"), "binding = 1}",
              "binding = 2}");
  tree["shaders/maps/cone/map.toml"] = cone;
  tree["shaders/maps/cone/bake.glsl"] = tree["shaders/maps/cone/normal.glsl"] = "";
  expect_rejected(tree, "shaders/maps/cone/map.toml", "describe.cycle", 4, 11, "cone → normal → cone");
}

TEST(LoadRegistry, RejectsFallbacksThatNeverEnd) {
  expect_rejected(tree_with("shaders/stages/prism/stage.toml", with(examples::stage, "\"prism_pulled\"", "\"prism\"")),
                  "shaders/stages/prism/stage.toml", "describe.cycle", 6, 12, "prism → prism");
}

TEST(LoadRegistry, AllowsAFallbackThatIsNotBuiltYet) {
  const auto registry = load_registry(examples::tree());
  ASSERT_TRUE(registry);
  EXPECT_EQ(registry->stages.at("prism").fallback, "prism_pulled");
  EXPECT_FALSE(registry->stages.contains("prism_pulled"));
}

TEST(LoadRegistry, RejectsParametersThatAreOneGlslIdentifier) {
  SourceTree tree = examples::tree();
  std::string text = with(examples::technique, "name = \"relief\"", "name = \"relief_linear\"");
  tree["techniques/relief_linear/technique.toml"] = with(text, "[loops.linear_steps]", "[loops.steps]");
  tree["techniques/relief_linear/relief.glsl"] = "";
  expect_rejected(tree, "techniques/relief_linear/technique.toml", "describe.duplicate", 12, 1,
                  "\"relief_linear_steps\" in GLSL");
}

TEST(Registry, LooksUpByName) {
  const auto registry = load_registry(examples::tree());
  ASSERT_TRUE(registry);
  ASSERT_TRUE(registry->technique("relief"));
  EXPECT_EQ(*registry->technique("relief"), &registry->techniques.at("relief"));
  EXPECT_TRUE(registry->map("normal"));
  EXPECT_TRUE(registry->stage("prism"));
}

TEST(Registry, NamesTheNearestOfAnUnknownName) {
  const auto registry = load_registry(examples::tree());
  ASSERT_TRUE(registry);
  const auto technique = registry->technique("releif");
  ASSERT_FALSE(technique);
  EXPECT_EQ(technique.error().code, ErrorCode::usage);
  examples::expect_error(technique.error(), "describe.unknown-technique", 0, 0,
                         R"("releif" is not known; the nearest is "relief")");
  examples::expect_error(registry->map("norml").error(), "describe.unknown-map", 0, 0, "\"normal\"");
  examples::expect_error(registry->stage("prisms").error(), "describe.unknown-stage", 0, 0, "\"prism\"");
  examples::expect_error(registry->map("tessellation").error(), "describe.unknown-map", 0, 0,
                         "known are height, normal");
  examples::expect_error(Registry{}.map("x").error(), "describe.unknown-map", 0, 0, "none is known");
}

}  // namespace
}  // namespace relievo
