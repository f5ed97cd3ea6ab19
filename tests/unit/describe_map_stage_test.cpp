#include <gtest/gtest.h>

#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

using examples::Fault;
using examples::with;

const std::string map_path = "shaders/maps/normal/map.toml";
const std::string stage_path = "shaders/stages/prism/stage.toml";

TEST(ParseMap, ReadsEveryField) {
  const auto map = parse_map(examples::map, map_path);
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->name, "normal");
  EXPECT_EQ(map->inputs, std::vector<std::string>{"height"});
  EXPECT_EQ(map->channels, 3);
  EXPECT_EQ(map->sampler, "relievo_normal_map");
  EXPECT_EQ(map->set, 1);
  EXPECT_EQ(map->binding, 1);
  EXPECT_EQ(map->module, "shaders/maps/normal/bake.glsl");
  EXPECT_EQ(map->access, "shaders/maps/normal/normal.glsl");
  EXPECT_EQ(map->file, map_path);
}

TEST(ParseMap, ReadsWithWhichAddressModesLayersAreApart) {
  const auto map =
      parse_map(with(examples::map, "channels = 3", "channels = 3\nlayers_apart = [\"clip\", \"repeat\"]"), map_path);
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->layers_apart, (std::vector<std::string>{"clip", "repeat"}));
}

TEST(ParseMap, ReadsHowManyLayersOneRunWrites) {
  const auto map = parse_map(with(examples::map, "channels = 3", "channels = 3\nlayers_at_once = 4"), map_path);
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->layers_at_once, 4);
  EXPECT_EQ(parse_map(examples::map, map_path)->layers_at_once, 1);
}

TEST(ParseMap, ReadsThePassesOfEveryPhase) {
  const auto with_passes = [](const std::string& passes) {
    return parse_map(with(examples::map, "channels = 3", "channels = 3\npasses = " + passes), map_path);
  };
  EXPECT_EQ(parse_map(examples::map, map_path)->passes, std::vector<int>{1});
  const auto one = with_passes("5"), three = with_passes("[1, 27, 1]");
  ASSERT_TRUE(one) << format(one.error());
  ASSERT_TRUE(three) << format(three.error());
  EXPECT_EQ(one->passes, std::vector<int>{5});
  EXPECT_EQ(three->passes, (std::vector<int>{1, 27, 1}));
  const auto zero = with_passes("[1, 0]");
  ASSERT_FALSE(zero);
  examples::expect_error(zero.error(), "describe.range", 6, 14, "is 0; an integer from 1 to 256");
  const auto many = with_passes("[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]");
  ASSERT_FALSE(many);
  examples::expect_error(many.error(), "describe.range", 6, 10, "17 phases; expected at most 16");
  for (const char* wrong : {"[]", "[1, \"two\"]", "1.5"}) {
    const auto refused = with_passes(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().id, "describe.type") << format(refused.error());
  }
}

TEST(ParseMap, ReadsTheFormatOfAnImage) {
  const std::string axis =
      "\n[axes.fetch]\ntitle = \"t\"\nvalues = [\"texture\", \"image\"]\ndefault = \"texture\"\nbinding = \"macro\"\n";
  const auto map = parse_map(with(examples::map, "sampler =", "image = \"rgba16\"\nsampler =") + axis, map_path);
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->image, "rgba16");
}

TEST(ParseMap, ReadsWhetherTexelsAreWholeNumbers) {
  EXPECT_FALSE(parse_map(examples::map, map_path)->is_uint);
  const std::string bits =
      "\n[parameters.bits]\ntitle = \"t\"\ntype = \"int\"\nmin = 16\nmax = 16\ndefault = 16\nbinding = \"macro\"\n";
  const std::string whole =
      with(examples::map, "channels = 3", "channels = 4\ntexels = \"uint\"\nrounding = \"up up up up\"");
  const auto map = parse_map(whole + bits, map_path);
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_TRUE(map->is_uint);
  const auto fewer_channels = parse_map(with(whole, "channels = 4", "channels = 2") + bits, map_path);
  ASSERT_FALSE(fewer_channels);
  const auto more_bits = parse_map(whole + with(bits, "max = 16", "max = 32"), map_path);
  ASSERT_FALSE(more_bits);
  EXPECT_EQ(more_bits.error().id, "describe.map-parameter") << format(more_bits.error());
  const auto no_bits = parse_map(with(examples::map, "channels = 3", "channels = 4\ntexels = \"uint\""), map_path);
  ASSERT_FALSE(no_bits);
  EXPECT_EQ(no_bits.error().id, "describe.map-parameter") << format(no_bits.error());
}

TEST(ParseMap, AllowsAProvidedMapWithoutAModule) {
  const auto map = parse_map(examples::provided_map, "shaders/maps/height/map.toml");
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_TRUE(map->module.empty());
  EXPECT_TRUE(map->access.empty());
  EXPECT_TRUE(map->inputs.empty());
}

TEST(ParseStage, ReadsEveryField) {
  const auto stage = parse_stage(examples::stage, stage_path);
  ASSERT_TRUE(stage) << format(stage.error());
  EXPECT_EQ(stage->name, "prism");
  EXPECT_EQ(stage->roles, std::vector<std::string>{"view"});
  EXPECT_EQ(stage->maps, std::vector<std::string>{"normal"});
  EXPECT_EQ(stage->fallback, "prism_pulled");
  EXPECT_EQ(stage->mesh, "base");
  ASSERT_EQ(stage->shaders.size(), 3u);
  EXPECT_EQ(stage->shaders[0].stage, ShaderStage::vertex);
  EXPECT_EQ(stage->shaders[1].stage, ShaderStage::geometry);
  EXPECT_EQ(stage->shaders[1].module, "shaders/stages/prism/prism.geom.glsl");
  EXPECT_EQ(stage->shaders[2].stage, ShaderStage::fragment);
}

TEST(ParseStage, ImpliesTheFeaturesOfItsShaders) {
  const auto stage = parse_stage(examples::stage, stage_path);
  ASSERT_TRUE(stage) << format(stage.error());
  EXPECT_EQ(stage->features, FeatureSet{"geometry"});
}

TEST(ParseStage, AcceptsComputeAlone) {
  const auto stage = parse_stage(
      "schema = 1\nname = \"ray\"\ntitle = \"Rays\"\n[[shader]]\nstage = \"compute\"\nmodule = \"ray.glsl\"\n",
      "shaders/stages/ray/stage.toml");
  ASSERT_TRUE(stage) << format(stage.error());
  EXPECT_EQ(stage->mesh, "none");
  EXPECT_EQ(stage->features, FeatureSet{"compute"});
  EXPECT_TRUE(stage->roles.empty());
}

class ParseMapRejects : public testing::TestWithParam<Fault> {};

TEST_P(ParseMapRejects, WithItsPlace) {
  const Fault& fault = GetParam();
  const auto map = parse_map(with(examples::map, fault.from, fault.to), map_path);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().file, map_path);
  examples::expect_error(map.error(), fault.id, fault.line, fault.column, fault.words);
}

const Fault map_faults[] = {
    {"UnknownKey", "sampler =", "sample =", "describe.unknown-key", 6, 1, R"(the nearest is "sampler")"},
    {"ZeroChannels", "channels = 3", "channels = 0", "describe.range", 5, 12, "from 1 to 4"},
    {"FiveChannels", "channels = 3", "channels = 5", "describe.range", 5, 12, "is 5; an integer from 1 to 4"},
    {"TextChannels", "channels = 3", "channels = \"three\"", "describe.type", 5, 12, "the string \"three\""},
    {"UnknownAddressOfLayersApart", "channels = 3", "channels = 3\nlayers_apart = [\"wrap\"]", "describe.range", 6, 17,
     "\"wrap\", which is not known"},
    {"TooManyLayersAtOnce", "channels = 3", "channels = 3\nlayers_at_once = 17", "describe.range", 6, 18,
     "from 1 to 16"},
    {"UnknownImageFormat", "sampler =", "image = \"rgb9\"\nsampler =", "describe.range", 6, 9, "rgb9"},
    {"ImageWithoutItsAxis", "sampler =", "image = \"rgba8\"\nsampler =", "describe.map-parameter", 1, 1,
     "an axis \"fetch\" with the value \"image\""},
    {"MissingSampler", "sampler = \"relievo_normal_map\"\n", "", "describe.missing-key", 1, 1, "\"sampler\""},
    {"BadSampler", "\"relievo_normal_map\"", "\"a-b\"", "describe.name", 6, 11, "GLSL identifier"},
    {"ReservedSampler", "\"relievo_normal_map\"", "\"gl_map\"", "describe.name", 6, 11, "\"gl_map\""},
    {"SamplerWithTwoUnderscores", "\"relievo_normal_map\"", "\"a__b\"", "describe.name", 6, 11, "__"},
    {"NumberBinding", "{set = 1, binding = 1}", "1", "describe.type", 7, 11, "a table is expected"},
    {"MissingBinding", "binding = {set = 1, binding = 1}\n", "", "describe.missing-key", 1, 1, "\"binding\""},
    {"MissingSet", "{set = 1, binding = 1}", "{binding = 1}", "describe.missing-key", 7, 11, "\"set\""},
    {"SetZero", "set = 1,", "set = 0,", "describe.range", 7, 18, "from 1 to 3"},
    {"NegativeBinding", "binding = 1}", "binding = -1}", "describe.range", 7, 31, "is -1"},
    {"UnknownBindingKey", "{set =", "{sett =", "describe.unknown-key", 7, 12, "the nearest is \"set\""},
    {"InputsWithoutModule", "module = \"bake.glsl\"\n", "", "describe.missing-key", 4, 10, "\"module\""},
    {"EscapingAccess", "\"normal.glsl\"", "\"../x.glsl\"", "describe.escapes-folder", 9, 10, "../x.glsl"},
    {"OtherFolder", "name = \"normal\"", "name = \"normals\"", "describe.name", 2, 8, "\"normal\", is expected"},
};

INSTANTIATE_TEST_SUITE_P(Faults, ParseMapRejects, testing::ValuesIn(map_faults), examples::fault_name);

TEST(ParseStage, HitsAreContinuousUnlessTheyMayLackTiles) {
  const auto continuous = parse_stage(examples::stage, stage_path);
  ASSERT_TRUE(continuous) << format(continuous.error());
  EXPECT_FALSE(continuous->hits_within_tile);
  const auto within = parse_stage(with(examples::stage, "mesh =", "hits = \"within_tile\"\nmesh ="), stage_path);
  ASSERT_TRUE(within) << format(within.error());
  EXPECT_TRUE(within->hits_within_tile);
}

class ParseStageRejects : public testing::TestWithParam<Fault> {};

TEST_P(ParseStageRejects, WithItsPlace) {
  const Fault& fault = GetParam();
  const auto stage = parse_stage(with(examples::stage, fault.from, fault.to), stage_path);
  ASSERT_FALSE(stage);
  EXPECT_EQ(stage.error().file, stage_path);
  examples::expect_error(stage.error(), fault.id, fault.line, fault.column, fault.words);
}

const Fault stage_faults[] = {
    {"UnknownKey", "fallback =", "fall_back =", "describe.unknown-key", 6, 1, R"(the nearest is "fallback")"},
    {"UnknownMesh", "\"base\"", "\"bases\"", "describe.range", 7, 8, R"(the nearest is "base")"},
    {"UnknownHits", "mesh = \"base\"", "hits = \"within_tiles\"", "describe.range", 7, 8,
     R"(the nearest is "within_tile")"},
    {"GraphicsWithoutMesh", "\"base\"", "\"none\"", "describe.range", 7, 8, "a mesh is expected"},
    {"UnknownShaderStage", "\"geometry\"", "\"geometri\"", "describe.range", 14, 9, R"(the nearest is "geometry")"},
    {"UnknownShaderKey", "module = \"prism.geom", "modul = \"prism.geom", "describe.unknown-key", 15, 1, "\"module\""},
    {"MissingModule", "module = \"prism.geom.glsl\"\n", "", "describe.missing-key", 13, 1,
     "shader 2 lacks the key \"module\""},
    {"RepeatedShader", "\"geometry\"", "\"vertex\"", "describe.duplicate", 14, 9, "second vertex"},
    {"WrongOrder", "\"vertex\"", "\"fragment\"", "describe.range", 14, 9, "pipeline order is expected"},
    {"ComputeBesideGraphics", "\"fragment\"", "\"compute\"", "describe.range", 18, 9, "either compute or graphics"},
    {"LoneTessellation", "\"geometry\"", "\"tessellation_control\"", "describe.missing-key", 9, 1, "evaluation"},
    {"EscapingModule", "\"prism.geom.glsl\"", "\"../a.glsl\"", "describe.escapes-folder", 15, 10, "../a.glsl"},
    {"BadRole", "[\"view\"]", "[\"View\"]", "describe.name", 4, 10, "\"View\""},
    {"BadFallback", "\"prism_pulled\"", "\"\"", "describe.name", 6, 12, "[a-z]"},
    {"ShaderTable", "[[shader]]", "[shader]", "describe.syntax", 13, 1, ""},
};

INSTANTIATE_TEST_SUITE_P(Faults, ParseStageRejects, testing::ValuesIn(stage_faults), examples::fault_name);

TEST(ParseStage, RejectsAStageWithoutAFragmentShader) {
  const std::string text =
      with(examples::stage, "[[shader]]\nstage = \"fragment\"\nmodule = \"prism.frag.glsl\"\n", "");
  const auto stage = parse_stage(text, stage_path);
  ASSERT_FALSE(stage);
  examples::expect_error(stage.error(), "describe.missing-key", 9, 1, "lacks a fragment shader");
}

TEST(ParseStage, RejectsAStageWithoutShaders) {
  const std::string head = "schema = 1\nname = \"prism\"\ntitle = \"P\"\n";
  const auto none = parse_stage(head, stage_path);
  ASSERT_FALSE(none);
  examples::expect_error(none.error(), "describe.missing-key", 1, 1, "\"shader\"");
  const auto empty = parse_stage(head + "shader = []\n", stage_path);
  ASSERT_FALSE(empty);
  examples::expect_error(empty.error(), "describe.type", 4, 10, "[[shader]]");
  const auto number = parse_stage(head + "shader = [3]\n", stage_path);
  ASSERT_FALSE(number);
  examples::expect_error(number.error(), "describe.type", 4, 11, "the integer 3");
}

TEST(ParseStage, RejectsAComputeStageWithAMesh) {
  const auto stage = parse_stage(
      "schema = 1\nname = \"ray\"\ntitle = \"R\"\nmesh = \"base\"\n[[shader]]\nstage = \"compute\"\nmodule = "
      "\"r.glsl\"\n",
      "shaders/stages/ray/stage.toml");
  ASSERT_FALSE(stage);
  examples::expect_error(stage.error(), "describe.range", 4, 8, "\"none\" is expected");
}

}  // namespace
}  // namespace relievo
