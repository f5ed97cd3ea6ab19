/// Manifests, and the permutations that they ask for.
#include <gtest/gtest.h>

#include "relievo/permute.hpp"
#include "support/files.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

constexpr const char* head = "schema = 1\nname = \"rocks\"\ntargets = [\"spirv-1.0\", \"essl-300\"]\n";

Manifest manifest_of(const std::string& lines) {
  const auto parsed = parse_manifest(head + lines, "project/relievo.toml");
  EXPECT_TRUE(parsed) << (parsed ? "" : format(parsed.error()));
  return parsed ? *parsed : Manifest{};
}

PermutationPlan plan_of(const std::string& lines) {
  const auto plan = plan_permutations(registry(), manifest_of(lines));
  EXPECT_TRUE(plan) << (plan ? "" : format(plan.error()));
  return plan ? *plan : PermutationPlan{};
}

const PlannedPermutation* find(const PermutationPlan& plan, const std::string& name) {
  for (const PlannedPermutation& planned : plan.permutations) {
    if (plan.name(planned) == name) return &planned;
  }
  return nullptr;
}

TEST(Manifest, ReadsAxesRulesAndWhatTheSceneNeeds) {
  const Manifest manifest = manifest_of(
      "folders = [\"mine\"]\noptimize = false\n[scene]\nmaps = [\"height\"]\nfirst_hit = \"always\"\n"
      "without_features = [\"geometry\"]\n[axes]\ntechnique = [\"relief\", \"exact\"]\n"
      "[axes.\"relief.linear_steps\"]\nvalues = [8, 16]\ndefault = 16\nbinding = \"specialization\"\n"
      "[[rule]]\nwhen = {technique = \"relief\"}\nexcludes = {address = \"clip\"}\nreason = \"no\"\n");
  EXPECT_EQ(manifest.name, "rocks");
  EXPECT_EQ(manifest.folders, std::vector<std::filesystem::path>{"project/mine"});
  EXPECT_FALSE(manifest.optimize);
  EXPECT_EQ(manifest.scene.first_hit, FirstHit::always);
  ASSERT_EQ(manifest.axes.size(), 2u);
  EXPECT_EQ(manifest.axes[1].values, (std::vector<std::string>{"8", "16"}));
  EXPECT_EQ(manifest.axes[1].default_value, "16");
  EXPECT_EQ(manifest.axes[1].binding, BindingTime::specialization);
  ASSERT_EQ(manifest.rules.size(), 1u);
  EXPECT_EQ(to_string(manifest.rules[0]), "technique = relief excludes address = clip: no");
}

TEST(Manifest, IsRefusedWithThePlaceAndTheExpectedValue) {
  const std::tuple<std::string, const char*, const char*> faults[] = {
      {"", "describe.missing-key", "\"axes\""},
      {"[axes]\ntechnique = []\n", "describe.type", "at least one"},
      {"[axes]\ntechnique = [\"relief\", \"relief\"]\n", "describe.duplicate", "twice"},
      {"[axes]\nstage = [\"ray\"]\n[scene]\nfirst_hit = \"allways\"\n", "describe.range", "\"always\""},
      {"[axis]\n", "describe.unknown-key", "\"axes\""},
      {"[axes.filter]\nvalues = [\"exact\"]\ndefault = \"hardware\"\n", "describe.range", "none of its values"},
      {"[axes.filter]\nvalues = [\"exact\"]\nbinding = \"macros\"\n", "describe.range", "\"macro\""},
  };
  for (const auto& [lines, id, words] : faults) {
    const auto parsed = parse_manifest(head + lines, "relievo.toml");
    ASSERT_FALSE(parsed) << lines;
    EXPECT_EQ(parsed.error().id, id) << format(parsed.error());
    EXPECT_NE(parsed.error().message.find(words), std::string::npos) << format(parsed.error());
    EXPECT_GT(parsed.error().line, 0) << format(parsed.error());
  }
  const auto bad_target = parse_manifest("schema = 1\nname = \"a\"\ntargets = [\"hlsl-5\"]\n[axes]\n", "relievo.toml");
  ASSERT_FALSE(bad_target);
  EXPECT_EQ(bad_target.error().id, "compile.unknown-target");
  EXPECT_EQ(bad_target.error().line, 3);
}

TEST(PermutationPlan, RefusesAxesAndValuesThatNobodyHas) {
  const std::tuple<std::string, const char*, const char*> faults[] = {
      {"[axes]\ntechnique = [\"relif\"]\n", "permute.value", "did you mean \"relief\"?"},
      {"[axes]\ntechnique = \"relief\"\nadress = \"clamp\"\n", "permute.unknown-axis", "did you mean \"address\"?"},
      {"[axes]\ntechnique = \"relief\"\n\"relief.linear_steps\" = [8, 1.5e9]\n", "permute.value", "1 to 65536"},
      {"[axes]\ntechnique = \"relief\"\nformat = [\"blue\"]\n", "permute.value", "red, alpha, red_green"},
      {"[axes]\ntechnique = \"relief\"\n\"relief.linear_steps\" = [\"8\", \"8.0\"]\n", "permute.duplicate", "twice"},
      {"[axes]\nstage = [\"surface\"]\n", "permute.no-technique", "\"technique\""},
  };
  for (const auto& [lines, id, words] : faults) {
    const auto manifest = parse_manifest(head + lines, "project/relievo.toml");
    ASSERT_TRUE(manifest) << format(manifest.error());
    const auto plan = plan_permutations(registry(), *manifest);
    ASSERT_FALSE(plan) << lines;
    EXPECT_EQ(plan.error().id, id) << format(plan.error());
    EXPECT_NE(plan.error().message.find(words), std::string::npos) << format(plan.error());
    EXPECT_EQ(plan.error().file, "project/relievo.toml");
    EXPECT_GT(plan.error().line, 0);
  }
}

/// Among 2^88 quadruples of values a few have shares in a key whose sums are equal, such as this one.
TEST(PermutationPlan, RefusesTwoPermutationsOfOneKey) {
  Registry wide = registry();
  for (Parameter& parameter : wide.techniques.at("relief").parameters) parameter.maximum = 1e7;
  const auto plan_with = [&](const std::string& binary_steps) {
    return plan_permutations(
        wide, manifest_of("[axes]\ntechnique = \"relief\"\n\"relief.linear_steps\" = [1, 4957314, 6650878]\n"
                          "\"relief.binary_steps\" = [1, " +
                          binary_steps + "]\n"));
  };
  const auto refused = plan_with("4312002, 7068877"), accepted = plan_with("4312002, 7068878");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, "permute.key-collision");
  for (const char* words : {"steps=4957314", "steps=6650878", "steps=4312002", "steps=7068877"})
    EXPECT_NE(refused.error().message.find(words), std::string::npos) << format(refused.error());
  EXPECT_EQ(refused.error().file, "project/relievo.toml");
  EXPECT_TRUE(accepted) << format(accepted.error());
}

TEST(PermutationPlan, GivesAPermutationOnlyTheAxesThatItHas) {
  const PermutationPlan plan = plan_of(
      "[axes]\ntechnique = [\"relief\", \"parallax\"]\nstage = [\"surface\", \"vertex\"]\n"
      "depth_write = [\"on\", \"off\"]\n\"relief.linear_steps\" = [8, 16]\n");
  EXPECT_EQ(plan.permutations.size(), 4u + 2u + 1u);
  EXPECT_TRUE(find(plan, "technique=relief stage=surface depth_write=off relief.linear_steps=16"));
  EXPECT_TRUE(find(plan, "technique=parallax stage=surface depth_write=off"));
  EXPECT_TRUE(find(plan, "stage=vertex"));
}

TEST(PermutationPlan, DropsAxesOfMapsThatAValueDoesWithout) {
  const PermutationPlan plan =
      plan_of("[axes]\ntechnique = \"relief\"\nnormal_source = [\"map\", \"height\"]\n\"normal.scale\" = [0.1, 0.2]\n");
  EXPECT_EQ(plan.permutations.size(), 3u);
  EXPECT_TRUE(find(plan, "technique=relief normal_source=map normal.scale=0.2"));
  EXPECT_TRUE(find(plan, "technique=relief normal_source=height"));
}

TEST(PermutationPlan, PrunesByCapabilitiesRulesAndTheScene) {
  const PermutationPlan plan = plan_of(
      "[scene]\nfirst_hit = \"if_steps_under_texel\"\n[axes]\ntechnique = [\"relief\", \"parallax\"]\n"
      "stage = [\"surface\", \"prism\"]\nfilter = [\"exact\", \"hardware\"]\nformat = [\"red\", \"red_green\"]\n"
      "[[rule]]\nwhen = {stage = \"prism\", target = \"spirv-1.0\"}\nrequires = {filter = \"exact\"}\n");
  const auto reason = [&](const std::string& name, std::size_t target) {
    const PlannedPermutation* planned = find(plan, name);
    EXPECT_TRUE(planned) << name;
    const std::uint32_t number = planned ? planned->pruned[target] : 0;
    return number == 0 ? std::string() : plan.reasons[number - 1];
  };
  EXPECT_EQ(reason("technique=relief stage=surface filter=exact format=red_green", 1), "");
  EXPECT_NE(reason("technique=parallax stage=surface filter=exact format=red", 0).find("the scene wants"),
            std::string::npos);
  EXPECT_NE(reason("technique=relief stage=surface filter=hardware format=red_green", 0).find("height.format"),
            std::string::npos);
  EXPECT_NE(reason("technique=relief stage=prism filter=exact format=red", 1).find("capability.geometry"),
            std::string::npos);
  EXPECT_EQ(reason("technique=relief stage=prism filter=exact format=red", 0), "");
  EXPECT_NE(reason("technique=relief stage=prism filter=hardware format=red", 0).find("(relievo.toml:"),
            std::string::npos);
}

TEST(PermutationPlan, KeepsKeysWhenAnAxisIsAdded) {
  const PermutationPlan before =
      plan_of("[axes]\ntechnique = [\"relief\", \"parallax\"]\naddress = [\"repeat\", \"clamp\"]\n");
  const PermutationPlan after = plan_of(
      "[axes]\nnormal_source = [\"map\", \"height\"]\naddress = [\"clamp\", \"repeat\"]\n"
      "technique = [\"relief\", \"parallax\"]\n");
  const PlannedPermutation* old_one = find(before, "technique=parallax address=clamp");
  const PlannedPermutation* new_one = find(after, "normal_source=map address=clamp technique=parallax");
  ASSERT_TRUE(old_one && new_one);
  EXPECT_EQ(old_one->key, new_one->key);
  EXPECT_EQ(find(before, "technique=relief address=repeat")->key, 0u);
  EXPECT_EQ(old_one->key, axis_key("technique", "parallax") + axis_key("address", "clamp"));
}

TEST(PermutationPlan, RefusesMoreThanTenMillion) {
  std::string values;
  for (int i = 1; i <= 4000; ++i) values += std::to_string(i) + ", ";
  const Manifest manifest =
      manifest_of("[axes]\ntechnique = \"parallax_occlusion\"\n\"parallax_occlusion.min_steps\" = [" + values +
                  "]\n\"parallax_occlusion.max_steps\" = [" + values + "]\n");
  const auto plan = plan_permutations(registry(), manifest);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().id, "permute.too-many");
}

TEST(PermutationPlan, ExplainsWhatIsKeptPrunedAndShared) {
  const Manifest manifest = manifest_of(
      "[axes]\ntechnique = [\"relief\", \"parallax\"]\nstage = [\"surface\", \"prism\"]\n\"relief.linear_steps\" = [8, "
      "16]\n");
  const auto plan = plan_permutations(registry(), manifest);
  ASSERT_TRUE(plan);
  const std::vector<std::pair<std::string, std::string>> prism = {{"stage", "prism"}};
  const auto text = explain(registry(), manifest, *plan, prism);
  ASSERT_TRUE(text) << format(text.error());
  EXPECT_NE(text->find("spirv-1.0: kept"), std::string::npos) << *text;
  EXPECT_NE(text->find("essl-300: pruned: target essl-300 has no geometry shaders"), std::string::npos) << *text;
  // The step count is a uniform: it makes no other program.
  EXPECT_NE(text->find("its source is that of 1 more"), std::string::npos) << *text;
  const std::vector<std::pair<std::string, std::string>> unknown = {{"stagee", "prism"}};
  EXPECT_EQ(explain(registry(), manifest, *plan, unknown).error().message,
            "the manifest has no axis 'stagee'; did you mean 'stage'?");
}

TEST(Manifest, OfThePageIsOne) {
  const std::string text = TemporaryFolder::read(RELIEVO_SOURCE_DIR "/docs/permutations.md");
  const std::size_t fence = text.find("```toml\n") + 8;
  const auto manifest = parse_manifest(text.substr(fence, text.find("```\n", fence) - fence), "docs/permutations.md");
  ASSERT_TRUE(manifest) << format(manifest.error());
  const auto plan = plan_permutations(registry(), *manifest);
  ASSERT_TRUE(plan) << format(plan.error());
  // relief: 2 addresses × 2 step counts × (2 depth writes on surfaces, 1 in prisms); parallax the same without counts.
  EXPECT_EQ(plan->permutations.size(), 2u * 2u * 3u + 2u * 3u);
}

TEST(Manifest, OfTheExampleAsksForTenThousand) {
  const auto manifest = load_manifest(RELIEVO_SOURCE_DIR "/examples/permutations/relievo.toml");
  ASSERT_TRUE(manifest) << format(manifest.error());
  const auto plan = plan_permutations(registry(), *manifest);
  ASSERT_TRUE(plan) << format(plan.error());
  EXPECT_GE(plan->permutations.size(), 10000u);
}

}  // namespace
}  // namespace relievo::test
