/// Manifests and techniques that are wrong: one sentence each, at the author's line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "support/permute_project.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A wrong manifest, and where and how it is said.
struct Wrong {
  std::string name, text, place, id, words;
};

const std::string kHead = "schema = 1\nname = \"small\"\ntargets = [\"spirv-1.0\"]\n";
const std::string kAxes = kHead + "[axes]\ntechnique = [\"bump\"]\n";
const std::string kRule = kAxes + "[[rule]]\n";

/// 11 techniques × 4000² combinations, none of them to be counted one by one.
std::string far_too_many() {
  std::string numbers = "1";
  for (int i = 2; i <= 4000; ++i) numbers += ", " + std::to_string(i);
  std::string text = kHead + "[axes]\ntechnique = \"all\"\n";
  for (const char* axis : {"parallax_occlusion.max_steps", "parallax_occlusion.min_steps", "linear_search.steps"})
    text += "\"" + std::string(axis) + "\" = [" + numbers + "]\n";
  return text;
}

std::vector<Wrong> wrong_manifests() {
  return {
      {"NotToml", "this is no TOML", "relievo.toml:1:", "describe.syntax", "expected '='"},
      {"Bytes", std::string("\xff\xfe\0\1", 4), "relievo.toml:1:", "describe.syntax", ""},
      {"Empty", "", "relievo.toml:1:", "describe.missing-key", "schema"},
      {"UnknownKey", "colour = 1\n" + kAxes, "relievo.toml:1:", "describe.unknown-key", "colour"},
      {"UnknownAxis", kAxes + "adress = [\"clamp\"]\n", "relievo.toml:6:", "permute.unknown-axis", "\"address\"?"},
      {"WrongValue", kAxes + "address = [\"clam\"]\n", "relievo.toml:6:", "permute.value", "\"clamp\"?"},
      {"OutOfRange", kAxes + "\"relief.binary_steps\" = [3, 65]\n", "relievo.toml:6:", "permute.value", "0 to 64"},
      {"NoNumber", kAxes + "\"relief.binary_steps\" = [\"few\"]\n", "relievo.toml:6:", "permute.value", "few"},
      {"Twice", kAxes + "address = [\"clamp\", \"clamp\"]\n", "relievo.toml:6:", "describe.duplicate", "twice"},
      {"TwiceInOtherWords", kAxes + "\"relief.binary_steps\" = [3, 3.0]\n", "relievo.toml:6:", "describe.duplicate",
       "twice"},
      {"NoValues", kAxes + "address = []\n", "relievo.toml:6:", "describe.type", "at least one"},
      {"WrongDefault", kAxes + "[axes.address]\nvalues = [\"clamp\"]\ndefault = \"clip\"\n",
       "relievo.toml:8:", "describe.range", "clip"},
      {"UnknownTechnique", kHead + "[axes]\ntechnique = [\"releif\"]\n", "relievo.toml:5:", "permute.value",
       "\"relief\"?"},
      {"UnknownTarget", "schema = 1\nname = \"a\"\ntargets = [\"spirv-9\"]\n[axes]\ntechnique = [\"bump\"]\n",
       "relievo.toml:3:", "compile.unknown-target", "spirv-1.0"},
      {"NoTargets", "schema = 1\nname = \"a\"\ntargets = []\n[axes]\ntechnique = [\"bump\"]\n",
       "relievo.toml:3:", "describe.type", "at least one"},
      {"NoTechniqueAxis", kHead + "[axes]\naddress = [\"clamp\"]\n", "relievo.toml:1:", "permute.no-technique", ""},
      {"NoAxes", kHead, "relievo.toml:1:", "describe.missing-key", "axes"},
      {"TooMany", far_too_many(), "relievo.toml:1:", "permute.too-many", "10000000"},
      {"RuleOnUnknownSubject", kRule + "when = { technik = \"bump\" }\nexcludes = { address = \"clamp\" }\n",
       "relievo.toml:6:", "permute.unknown-subject", "\"technik\""},
      {"RuleOnUnknownParameter", kRule + "excludes = { \"surface.nothing\" = \"on\" }\n",
       "relievo.toml:6:", "permute.unknown-subject", "surface.nothing"},
      {"RuleOnUnknownTechnique", kRule + "excludes = { technique = \"bumpp\" }\n", "relievo.toml:6:", "permute.value",
       "\"bump\"?"},
      {"RuleOnUnknownValue", kRule + "excludes = { \"surface.depth_write\" = \"maybe\" }\n",
       "relievo.toml:6:", "permute.value", "maybe"},
      {"RuleThatSaysNothing", kRule + "reason = \"none\"\n", "relievo.toml:6:", "describe.missing-key", "excludes"},
      {"NoSuchFolder", "folders = [\"techniques\"]\n" + kAxes, "relievo.toml:1:", "permute.folder", "techniques"},
  };
}

class PermuteWrongManifest : public ::testing::TestWithParam<Wrong> {};

TEST_P(PermuteWrongManifest, IsSaidInOneSentenceAtItsLine) {
  const PermuteProject project(GetParam().text);
  const auto start = std::chrono::steady_clock::now();
  const ChildResult result = project.run("out", {"--no-cache"});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(GetParam().place));
  EXPECT_THAT(result.err, HasSubstr("[" + GetParam().id + "]"));
  EXPECT_THAT(result.err, HasSubstr(GetParam().words));
  EXPECT_FALSE(fs::exists(project / "out"));
}

INSTANTIATE_TEST_SUITE_P(Every, PermuteWrongManifest, ::testing::ValuesIn(wrong_manifests()),
                         [](const auto& test) { return test.param.name; });

TEST(PermuteManifest, TheOneThatTheOthersAreMadeFromIsRight) {
  const std::string rule =
      "when = { technique = \"bump\", target = \"spirv-1.0\", maps = \"height\" }\n"
      "excludes = { \"surface.depth_write\" = \"on\", address = \"clip\" }\n";
  for (const std::string& text : {kAxes, kRule + rule})
    EXPECT_EQ(PermuteProject(text).run("out", {"--no-cache"}).exit_code, 0);
}

TEST(PermuteManifest, ThatCannotBeReadIsNamed) {
  const TemporaryFolder folder;
  for (const std::string& path : {(folder / "absent.toml").string(), folder.path().string()}) {
    const ChildResult result = run_relievo({"permute", path, "-o", folder / "out"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr(path + ": error: "));
    EXPECT_THAT(result.err, HasSubstr("[permute.manifest]"));
  }
}

double children_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// A technique of the user with this module, in 512 permutations.
class PermuteBrokenTechnique : public ::testing::Test {
 protected:
  static std::string manifest() {
    std::string many;
    for (int i = 1; i <= 64; ++i) many += (i > 1 ? ", " : "") + std::to_string(i);
    return "folders = [\"techniques\"]\nschema = 1\nname = \"small\"\ntargets = [\"spirv-1.0\", \"glsl-450\"]\n[axes]\n"
           "technique = [\"mine\"]\naddress = [\"repeat\", \"mirror\", \"clamp\", \"clip\"]\n"
           "filter = [\"hardware\", \"exact\"]\n[axes.\"mine.steps\"]\nvalues = [" +
           many + "]\nbinding = \"macro\"\n";
  }
  void write(const std::string& body) const {
    fs::create_directories(project_ / "techniques/mine");
    project_.folder().write(
        "techniques/mine/technique.toml",
        "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nsource = \"none\"\nsummary = \"A test.\"\n"
        "class = \"non_iterative\"\nfirst_hit = \"never\"\nmodule = \"mine.glsl\"\nmaps = [\"height\"]\n"
        "features = [\"explicit_lod\"]\n[loops.steps]\ntitle = \"Steps\"\nbounds = \"steps\"\nmin = 1\n"
        "max = 64\ndefault = 8\nbinding = \"macro\"\n");
    project_.folder().write("techniques/mine/mine.glsl",
                            "#include \"shaders/lib/interval.glsl\"\n\nHit mine_trace(Ray ray) {\n" + body +
                                "  return relievo_hit_at(ray, RELIEVO_MISS, 0.0);\n}\n");
  }
  const PermuteProject project_{manifest()};
};

TEST_F(PermuteBrokenTechnique, IsReportedOnceWithPlaceAndCount) {
  write("  float t = mine_steps * 1.0\n");  // a semicolon is missing: said at the next token
  const ChildResult result = project_.run("out", {"--no-cache"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr(project_ / "techniques/mine/mine.glsl:5:3: error: "));
  EXPECT_THAT(result.err, HasSubstr("the same error in 512 of 512 permutations"));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 3) << result.err;  // error, note, and the end
  EXPECT_FALSE(fs::exists(project_ / "out/small.rla"));
  const auto json = nlohmann::json::parse(project_.run("out", {"--no-cache", "--json"}).out);
  EXPECT_EQ(json["errors"].size(), 1u);
}

TEST_F(PermuteBrokenTechnique, IsReportedInLessTimeThanItCompilesWhenMended) {
  const auto seconds_of = [this](const std::string& body, std::vector<std::string> arguments, int exit_code) {
    write(body);
    const double before = children_seconds();  // of the processor: a busy machine makes the wall time longer
    EXPECT_EQ(project_.run("out", std::move(arguments)).exit_code, exit_code);
    return children_seconds() - before;
  };
  const double broken = seconds_of("  float t = mine_steps * 1.0\n", {"--no-cache", "-j", "1"}, 2);
  const double sixteenth =
      seconds_of("  float t = float(mine_steps) * 1.0;\n", {"--no-cache", "-j", "1", "--shard", "1/16"}, 0);
  std::printf("an error in 512 permutations takes %.2f s of CPU time, compiling 32 of them %.2f s\n", broken,
              sixteenth);
  EXPECT_LT(broken, 0.75 * 16 * sixteenth);
}

}  // namespace
}  // namespace relievo::test
