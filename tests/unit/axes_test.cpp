/// Axes of descriptors: values with names, what they bring, and the rules between them.
#include <gtest/gtest.h>

#include "relievo/compile.hpp"
#include "relievo/maps.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

constexpr const char* head =
    "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"unsafe\"\nfirst_hit = \"never\"\n"
    "module = \"mine.glsl\"\nmaps = [\"height\"]\n";

/// The axis of a descriptor with these lines in its table.
std::string with_axis(const std::string& lines) {
  return std::string(head) + "[axes.detail]\n" + lines;
}

Error parse_error(const std::string& text) {
  const auto parsed = parse_technique(text, "techniques/mine/technique.toml");
  EXPECT_FALSE(parsed) << "parses";
  return parsed ? Error{} : parsed.error();
}

TEST(DescriptorAxes, HaveNamedValuesAndWhatTheyBring) {
  const auto parsed = parse_technique(
      with_axis("title = \"Detail\"\nvalues = [\"low\", \"high\"]\ndefault = \"high\"\nbinding = \"macro\"\n"
                "maps = {high = [\"normal\"]}\nfeatures = {high = [\"gather\"]}\n"
                "[[axes.detail.rule]]\nvalues = [\"high\"]\nrequires = {filter = \"exact\", stage = [\"surface\", "
                "\"prism\"]}\nexcludes = {features = \"compute\"}\nreason = \"so it is\"\n"),
      "techniques/mine/technique.toml");
  ASSERT_TRUE(parsed) << format(parsed.error());
  ASSERT_EQ(parsed->parameters.size(), 1u);
  const Parameter& axis = parsed->parameters[0];
  EXPECT_EQ(axis.choices, (std::vector<std::string>{"low", "high"}));
  EXPECT_EQ(axis.value, 1);
  EXPECT_EQ(axis.maximum, 1);
  EXPECT_TRUE(axis.maps[0].empty());
  EXPECT_EQ(axis.maps[1], std::vector<std::string>{"normal"});
  EXPECT_TRUE(axis.features[1].contains("gather"));
  ASSERT_EQ(axis.rules.size(), 3u);
  EXPECT_EQ(to_string(axis.rules[0]), "mine.detail = high requires filter = exact: so it is");
  EXPECT_EQ(to_string(axis.rules[2]), "mine.detail = high excludes features = compute: so it is");
  EXPECT_EQ(*parse_value(axis, "low"), 0);
  EXPECT_EQ(value_text(axis, 1), "high");
  EXPECT_EQ(parse_value(axis, "medium").error().message,
            "the value of \"detail\" is \"medium\"; one of low, high is expected");
}

/// A registry of one technique with an axis whose value "high" suits software drivers and needs `gather`.
Registry registry_with_software_value() {
  Registry registry;
  registry.techniques["mine"] =
      *parse_technique(with_axis("title = \"Detail\"\nvalues = [\"low\", \"high\"]\ndefault = \"low\"\n"
                                 "software = \"high\"\nfeatures = {high = [\"gather\"]}\n"),
                       "techniques/mine/technique.toml");
  return registry;
}

TEST(ValuesOn, ASoftwareDriverAreWhatSuitsItWhereAxesAreLeftOpen) {
  const Registry registry = registry_with_software_value();
  BackendInfo backend;
  backend.features = {"gather", "software"};
  using Values = std::map<std::string, double>;
  EXPECT_EQ(values_on(registry, backend, {}), (Values{{"mine.detail", 1}}));
  EXPECT_EQ(values_on(registry, backend, {{"mine.detail", 0}}), (Values{{"mine.detail", 0}})) << "was asked for";
  backend.features = {"software"};
  EXPECT_EQ(values_on(registry, backend, {}), Values()) << "lacks what the value needs";
  backend.features = {"gather"};
  EXPECT_EQ(values_on(registry, backend, {}), Values()) << "is no software driver";
}

TEST(DescriptorAxes, AreRefusedWithThePlaceAndTheNearestName) {
  const std::string start = "title = \"Detail\"\nvalues = [\"low\", \"high\"]\n";
  const std::tuple<std::string, const char*, const char*> faults[] = {
      {"title = \"D\"\nvalues = [\"low\"]\ndefault = \"low\"\n", "describe.range", "two or more"},
      {start + "default = \"hihg\"\n", "describe.range", "the nearest is \"high\""},
      {start, "describe.missing-key", "\"default\""},
      {start + "default = \"low\"\nsoftware = \"hihg\"\n", "describe.range", "\"software\""},
      {start + "default = \"low\"\nmaps = {hgh = [\"normal\"]}\n", "describe.range", "the nearest is \"high\""},
      {start + "default = \"low\"\nfeatures = {high = [\"gathr\"]}\n", "describe.unknown-feature", "\"gather\""},
      {start + "default = \"low\"\nbinding = \"uniform\"\nbindings = [\"macro\"]\n", "describe.range", "leave out"},
      {start + "default = \"low\"\n[[axes.detail.rule]]\nvalues = [\"high\"]\n", "describe.missing-key",
       "\"requires\" or \"excludes\""},
      {start + "default = \"low\"\nmin = 0\n", "describe.unknown-key", "\"min\""},
      {"title = \"D\"\nvalues = [\"16\", \"32\"]\ndefault = \"16\"\n", "describe.name", "\"16\""},
  };
  for (const auto& [lines, id, words] : faults) {
    const Error error = parse_error(with_axis(lines));
    EXPECT_EQ(error.id, id) << lines << error.message;
    EXPECT_NE(error.message.find(words), std::string::npos) << error.message;
    EXPECT_GT(error.line, 7) << error.message;
  }
}

TEST(DescriptorAxes, MayNotHaveTheNameOfALoop) {
  const Error error = parse_error(std::string(head) +
                                  "[loops.detail]\ntitle = \"D\"\nbounds = \"b\"\nmin = 1\nmax = 2\ndefault = 1\n"
                                  "[axes.detail]\ntitle = \"D\"\nvalues = [\"a\", \"b\"]\ndefault = \"a\"\n");
  EXPECT_EQ(error.id, "describe.duplicate");
}

Facts some_facts() {
  return {{"stage", {"surface"}}, {"filter", {"exact"}}, {"maps", {"height", "normal"}}};
}

TEST(Rules, AskForOneOfTheWordsOrForAllOfASet) {
  const Condition surface = {"stage", {"surface"}};
  EXPECT_FALSE(is_broken({{surface}, {"filter", {"exact", "hardware"}}, false, "", "", 0}, some_facts()));
  EXPECT_TRUE(is_broken({{surface}, {"filter", {"hardware"}}, false, "", "", 0}, some_facts()));
  EXPECT_TRUE(is_broken({{surface}, {"filter", {"exact"}}, true, "", "", 0}, some_facts()));
  EXPECT_FALSE(is_broken({{surface}, {"maps", {"height", "normal"}}, false, "", "", 0}, some_facts()));
  EXPECT_TRUE(is_broken({{surface}, {"maps", {"height", "cone"}}, false, "", "", 0}, some_facts()));
  EXPECT_TRUE(is_broken({{surface}, {"maps", {"normal"}}, true, "", "", 0}, some_facts()));
}

TEST(Rules, SayNothingWhereTheyDoNotApply) {
  EXPECT_FALSE(is_broken({{{"stage", {"prism"}}}, {"filter", {"hardware"}}, false, "", "", 0}, some_facts()));
  EXPECT_FALSE(is_broken({{{"relief.linear_steps", {"8"}}}, {"filter", {"hardware"}}, false, "", "", 0}, some_facts()));
  EXPECT_FALSE(is_broken({{}, {"target", {"hlsl-5.0"}}, false, "", "", 0}, some_facts()));
  EXPECT_TRUE(is_broken({{}, {"filter", {"hardware"}}, false, "", "", 0}, some_facts()));
}

Permutation surface_of(const std::string& technique) {
  Permutation permutation;
  permutation.stage = "surface";
  permutation.roles["view"] = technique;
  return permutation;
}

bool has_map(const ComposedProgram& program, const std::string& name) {
  return std::any_of(program.maps.begin(), program.maps.end(), [&](const MapSlot& map) { return map.map == name; });
}

TEST(ComposeAxes, BindOnlyTheMapsOfTheChosenValue) {
  const Registry registry = *load_registry();
  const auto by_map = compose(registry, surface_of("relief"));
  ASSERT_TRUE(by_map);
  EXPECT_TRUE(has_map(*by_map, "normal"));
  Permutation permutation = surface_of("relief");
  permutation.values["surface.normal_source"] = 1;
  const auto by_height = compose(registry, permutation);
  ASSERT_TRUE(by_height) << format(by_height.error());
  EXPECT_FALSE(has_map(*by_height, "normal"));
  const auto compiled = compile(*by_height, all_targets());
  ASSERT_TRUE(compiled) << format(compiled.error());
  for (const BindingSlot& slot : compiled->bindings) EXPECT_NE(slot.name, "relievo_normal_map");
}

/// A map may have an axis that needs another map, though none of ours has.
TEST(RequiredMaps, FollowTheAxesOfMapsToo) {
  Registry registry = *load_registry();
  Parameter axis;
  axis.name = "kind";
  axis.choices = {"plain", "fancy"};
  axis.maps = {{}, {"min_max_pyramid"}};
  registry.maps.at("max_pyramid").parameters.push_back(axis);
  const auto maps = required_maps(registry, "ray", "exact");
  ASSERT_TRUE(maps);
  EXPECT_EQ(std::count(maps->begin(), maps->end(), "min_max_pyramid"), 1);
}

TEST(ComposeAxes, LeaveOutTheCodeOfOtherValues) {
  const Registry registry = *load_registry();
  Permutation permutation = surface_of("relief");
  permutation.values["surface.depth_write"] = 1;
  const auto composed = compose(registry, permutation);
  ASSERT_TRUE(composed);
  EXPECT_FALSE(composed->features.contains("depth_write"));
  const Target target = *parse_target("glsl-450");
  const auto compiled = compile(*composed, std::span(&target, 1));
  ASSERT_TRUE(compiled) << format(compiled.error());
  for (const CompiledShader& shader : compiled->shaders)
    EXPECT_EQ(shader.text.at("glsl-450").find("gl_FragDepth"), std::string::npos);
}

TEST(ComposeAxes, RefuseWhatARuleForbids) {
  const Registry registry = *load_registry();
  Permutation permutation = surface_of("relief");
  permutation.filter = HeightFilter::hardware;
  permutation.values["height.format"] = 2;
  const auto composed = compose(registry, permutation);
  ASSERT_FALSE(composed);
  EXPECT_EQ(composed.error().id, "compose.rule");
  EXPECT_EQ(composed.error().file, "shaders/maps/height/map.toml");
  EXPECT_GT(composed.error().line, 1);
  permutation.filter = HeightFilter::exact;
  EXPECT_TRUE(compose(registry, permutation));
}

TEST(ComposeAxes, TakeOnlyTheBindingsThatTheyAllow) {
  const Registry registry = *load_registry();
  Permutation permutation = surface_of("relief");
  permutation.binding_times["surface.depth_write"] = BindingTime::uniform;
  const auto composed = compose(registry, permutation);
  ASSERT_FALSE(composed);
  EXPECT_EQ(composed.error().id, "compose.binding");
  EXPECT_EQ(composed.error().message, "surface.depth_write is bound as uniform; expected macro");
}

}  // namespace
}  // namespace relievo::test
