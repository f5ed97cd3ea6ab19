#include <gtest/gtest.h>

#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

using examples::Fault;
using examples::with;

const std::string path = "techniques/relief/technique.toml";

TEST(ParseTechnique, ReadsEveryField) {
  const auto technique = parse_technique(examples::technique, path);
  ASSERT_TRUE(technique) << format(technique.error());
  EXPECT_EQ(technique->name, "relief");
  EXPECT_EQ(technique->title, "Relief mapping");
  EXPECT_EQ(technique->source, "Policarpo, Oliveira, Comba 2005");
  EXPECT_EQ(technique->summary, "Linear search, then binary refinement.");
  EXPECT_EQ(technique->technique_class, TechniqueClass::combined);
  EXPECT_EQ(technique->first_hit, FirstHit::if_steps_under_texel);
  EXPECT_EQ(technique->module, "techniques/relief/relief.glsl");
  EXPECT_EQ(technique->maps, std::vector<std::string>{"height"});
  EXPECT_EQ(technique->features, (FeatureSet{"dynamic_loops", "explicit_lod"}));
  EXPECT_EQ(technique->file, path);
}

TEST(ParseTechnique, ReadsLoopsBeforeParameters) {
  const auto technique = parse_technique(examples::technique, path);
  ASSERT_TRUE(technique);
  ASSERT_EQ(technique->parameters.size(), 2u);
  const Parameter& loop = technique->parameters[0];
  EXPECT_EQ(loop.name, "linear_steps");
  EXPECT_TRUE(loop.is_loop && loop.is_integer);
  EXPECT_EQ(loop.unit, "steps from entry to exit");
  EXPECT_EQ(loop.minimum, 1);
  EXPECT_EQ(loop.maximum, 4096);
  EXPECT_EQ(loop.value, 100);
  EXPECT_EQ(loop.binding, BindingTime::macro);
  EXPECT_EQ(loop.file, path);
  EXPECT_EQ(loop.line, 12);
  const Parameter& bias = technique->parameters[1];
  EXPECT_EQ(bias.name, "bias");
  EXPECT_FALSE(bias.is_loop || bias.is_integer);
  EXPECT_EQ(bias.unit, "texels");
  EXPECT_EQ(bias.maximum, 1.5);
  EXPECT_EQ(bias.value, 0.5);
  EXPECT_EQ(bias.binding, BindingTime::specialization);
}

TEST(ParseTechnique, FillsDefaults) {
  const auto technique = parse_technique(R"(schema = 1
name = "flat"
title = "Flat"
class = "non_iterative"
first_hit = "never"
module = "flat.glsl"
[parameters.amount]
title = "Amount"
min = -1.0
max = 1.0
default = 0.0
)",
                                         "techniques/flat/technique.toml");
  ASSERT_TRUE(technique) << format(technique.error());
  EXPECT_TRUE(technique->maps.empty());
  EXPECT_TRUE(technique->features.empty());
  EXPECT_EQ(technique->parameters.at(0).unit, "1");
  EXPECT_EQ(technique->parameters.at(0).binding, BindingTime::uniform);
  EXPECT_FALSE(technique->parameters.at(0).is_integer);
}

TEST(ParseTechnique, KeepsParametersInTheirOrder) {
  std::string text(examples::technique);
  text += "[parameters.alpha]\ntitle = \"A\"\ntype = \"int\"\nmin = 0\nmax = 9\ndefault = 3\n";
  const auto technique = parse_technique(text, path);
  ASSERT_TRUE(technique) << format(technique.error());
  EXPECT_EQ(technique->parameters.at(1).name, "bias");
  EXPECT_EQ(technique->parameters.at(2).name, "alpha");
  EXPECT_TRUE(technique->parameters.at(2).is_integer);
}

TEST(ParseTechnique, ResolvesItsModuleAgainstItsFolder) {
  const auto nested = parse_technique(with(examples::technique, "relief.glsl", "./glsl//a/../trace.glsl"), path);
  ASSERT_TRUE(nested) << format(nested.error());
  EXPECT_EQ(nested->module, "techniques/relief/glsl/trace.glsl");
  const auto bare = parse_technique(examples::technique, "technique.toml");
  ASSERT_TRUE(bare) << format(bare.error());
  EXPECT_EQ(bare->module, "relief.glsl");
}

TEST(ParseTechnique, ReadsEveryClassAndGuarantee) {
  for (const auto value : {TechniqueClass::non_iterative, TechniqueClass::unsafe, TechniqueClass::quasi_safe,
                           TechniqueClass::safe, TechniqueClass::combined}) {
    const auto technique = parse_technique(with(examples::technique, "combined", to_string(value)), path);
    ASSERT_TRUE(technique) << format(technique.error());
    EXPECT_EQ(technique->technique_class, value);
  }
  for (const auto value : {FirstHit::never, FirstHit::if_steps_under_texel, FirstHit::always}) {
    const auto technique = parse_technique(with(examples::technique, "if_steps_under_texel", to_string(value)), path);
    ASSERT_TRUE(technique) << format(technique.error());
    EXPECT_EQ(technique->first_hit, value);
  }
}

class ParseTechniqueRejects : public testing::TestWithParam<Fault> {};

TEST_P(ParseTechniqueRejects, WithItsPlace) {
  const Fault& fault = GetParam();
  const auto technique = parse_technique(with(examples::technique, fault.from, fault.to), path);
  ASSERT_FALSE(technique);
  EXPECT_EQ(technique.error().code, ErrorCode::descriptor);
  EXPECT_EQ(technique.error().file, path);
  examples::expect_error(technique.error(), fault.id, fault.line, fault.column, fault.words);
}

const Fault faults[] = {
    {"Syntax", "class = ", "class ", "describe.syntax", 6, 7, ""},
    {"UnclosedString", "\"relief.glsl\"", "\"relief.glsl", "describe.syntax", 8, 22, ""},
    {"RepeatedKey", "title = \"Relief", "name = \"Relief", "describe.syntax", 3, 8, ""},
    {"UnknownKey", "title =", "tittle =", "describe.unknown-key", 3, 1, R"("tittle"; the nearest is "title")"},
    {"UnknownLoopKey", "bounds =", "bound =", "describe.unknown-key", 14, 1, R"("bound"; the nearest is "bounds")"},
    {"UnitOfALoop", "bounds = \"steps", "unit = \"steps", "describe.unknown-key", 14, 1, "known are title, bounds"},
    {"UnknownParameterKey", "unit =", "units =", "describe.unknown-key", 22, 1, R"(the nearest is "unit")"},
    {"MissingKey", "title = \"Relief mapping\"\n", "", "describe.missing-key", 1, 1, R"(lacks the key "title")"},
    {"MissingSchema", "schema = 1\n", "", "describe.missing-key", 1, 1, R"(lacks the key "schema")"},
    {"MissingBounds", "bounds = \"steps from entry to exit\"\n", "", "describe.missing-key", 12, 1,
     R"(loop "linear_steps" lacks the key "bounds")"},
    {"MissingDefault", "default = 0.5\n", "", "describe.missing-key", 20, 1, R"(lacks the key "default")"},
    {"BlankTitle", "\"Relief mapping\"", "\" \"", "describe.missing-key", 3, 9, "is empty"},
    {"NewerSchema", "schema = 1", "schema = 2", "describe.range", 1, 10, "is 2; this version reads schemas up to 1"},
    {"NewerSchemaBeforeItsKeys", "schema = 1\n", "schema = 9\nnovel = 1\n", "describe.range", 1, 10, "is 9"},
    {"ZeroSchema", "schema = 1", "schema = 0", "describe.range", 1, 10, "is 0"},
    {"TextSchema", "schema = 1", "schema = \"1\"", "describe.type", 1, 10, "the string \"1\"; an integer is expected"},
    {"NumberTitle", "\"Relief mapping\"", "7", "describe.type", 3, 9, "the integer 7; a string is expected"},
    {"TextMaps", "[\"height\"]", "\"height\"", "describe.type", 9, 8, "an array of strings is expected"},
    {"NumberInMaps", "[\"height\"]", "[1.5]", "describe.type", 9, 9, "the float 1.5"},
    {"FlatLoops", "[loops.linear_steps]", "[loops]", "describe.type", 13, 9, "the table of a loop is expected"},
    {"FractionalLoop", "default = 100", "default = 100.0", "describe.type", 17, 11, "the float 100; an integer"},
    {"NegativeLoop", "min = 1\n", "min = -1\n", "describe.range", 15, 7, "is -1; an integer from 0"},
    {"HugeLoop", "max = 4096", "max = 2147483648", "describe.range", 16, 7, "2147483647"},
    {"MinAboveMax", "max = 4096", "max = 50", "describe.range", 17, 11, "is 100; a value from 1 to 50 is expected"},
    {"SwappedRange", "min = 0\nmax = 1.5", "min = 2\nmax = 1.5", "describe.range", 24, 7,
     "is 2, above its \"max\" 1.5"},
    {"DefaultTooSmall", "default = 0.5", "default = -0.1", "describe.range", 26, 11, "is -0.1; a value from 0 to 1.5"},
    {"NotANumber", "default = 0.5", "default = nan", "describe.range", 26, 11, "finite"},
    {"Infinity", "max = 1.5", "max = inf", "describe.range", 25, 7, "finite"},
    {"TooLargeForAFloat", "max = 1.5", "max = 1e39", "describe.range", 25, 7, "32-bit"},
    {"BooleanNumber", "max = 1.5", "max = true", "describe.type", 25, 7, "the boolean true; a number is expected"},
    {"UnknownClass", "\"combined\"", "\"combine\"", "describe.range", 6, 9,
     R"("combine", which is not known; the nearest is "combined")"},
    {"UnknownGuarantee", "\"if_steps_under_texel\"", "\"sometimes\"", "describe.range", 7, 13, "known are never"},
    {"UnknownBinding", "\"macro\"", "\"macros\"", "describe.range", 18, 11, "the nearest is \"macro\""},
    {"UnknownType", "\"float\"", "\"floaty\"", "describe.range", 23, 8, "the nearest is \"float\""},
    {"UnknownFeature", "\"explicit_lod\"", "\"explicit_lods\"", "describe.unknown-feature", 10, 30,
     R"(the nearest is "explicit_lod")"},
    {"RepeatedFeature", "\"explicit_lod\"", "\"dynamic_loops\"", "describe.duplicate", 10, 30, "twice"},
    {"RepeatedMap", "[\"height\"]", "[\"height\", \"height\"]", "describe.duplicate", 9, 19, "twice"},
    {"BadMapName", "[\"height\"]", "[\"Height\"]", "describe.name", 9, 9, "[a-z]"},
    {"CapitalName", "\"relief\"", "\"Relief\"", "describe.name", 2, 8, "[a-z]"},
    {"DoubleUnderscore", "\"relief\"", "\"re__lief\"", "describe.name", 2, 8, "__"},
    {"ReservedPrefix", "\"relief\"", "\"gl_relief\"", "describe.name", 2, 8, "reserved"},
    {"OtherFolder", "\"relief\"", "\"relive\"", "describe.name", 2, 8, R"(its folder, "relief", is expected)"},
    {"BadLoopName", "[loops.linear_steps]", "[loops.Linear]", "describe.name", 12, 8, "\"Linear\""},
    {"TraceParameter", "[parameters.bias]", "[parameters.trace]", "describe.name", 20, 1, "relief_trace"},
    {"LoopAndParameter", "[parameters.bias]", "[parameters.linear_steps]", "describe.duplicate", 20, 1, "a loop"},
    {"ParentModule", "\"relief.glsl\"", "\"../relief.glsl\"", "describe.escapes-folder", 8, 10, "../relief.glsl"},
    {"DeepParentModule", "\"relief.glsl\"", "\"a/../../relief.glsl\"", "describe.escapes-folder", 8, 10, ""},
    {"AbsoluteModule", "\"relief.glsl\"", "\"/etc/relief.glsl\"", "describe.escapes-folder", 8, 10, ""},
    {"BackslashModule", "\"relief.glsl\"", "'..\\relief.glsl'", "describe.escapes-folder", 8, 10, ""},
    {"EmptyModule", "\"relief.glsl\"", "\"\"", "describe.escapes-folder", 8, 10, ""},
};

INSTANTIATE_TEST_SUITE_P(Faults, ParseTechniqueRejects, testing::ValuesIn(faults), examples::fault_name);

TEST(ParseTechnique, NamesTheFirstErrorOfTheFile) {
  const std::string text = with(with(examples::technique, "title =", "tittle ="), "source =", "sorce =");
  const auto technique = parse_technique(text, path);
  ASSERT_FALSE(technique);
  EXPECT_EQ(technique.error().line, 3);
}

TEST(ParseTechnique, ShortensAndEscapesTheGivenValue) {
  const std::string value = "\\u0007" + std::string(2000, 'x');
  const auto technique = parse_technique(with(examples::technique, "combined", value), path);
  ASSERT_FALSE(technique);
  EXPECT_LT(technique.error().message.size(), 300u);
  EXPECT_NE(technique.error().message.find("\\x07xxx"), std::string::npos) << technique.error().message;
}

}  // namespace
}  // namespace relievo
