/// `relievo conform --hard-cases`: a technique that claims too much is caught, and so is one that gives NaN.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/child.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

class ConformCli : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("cases.toml",
                  "schema = 1\n[[case]]\nname = \"thin\"\nrule = \"a wall of one texel\"\n"
                  "map = {kind = \"wall\", width = 64, height = 8, along = \"v\"}\n"
                  "rays = {kind = \"random\", angle = 10, angle_to = 30}\naddress = [\"repeat\", \"clip\"]\n");
  }
  /// A technique of a user with a claim of first hits.
  void write_technique(const std::string& body, const std::string& first_hit = "always") const {
    fs::create_directories(folder_ / "techniques/mine");
    folder_.write(
        "techniques/mine/technique.toml",
        "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"safe\"\nfirst_hit = \"" + first_hit +
            "\"\nmodule = \"mine.glsl\"\nmaps = [\"height\"]\nfeatures = [\"dynamic_loops\", \"explicit_lod\"]\n");
    folder_.write("techniques/mine/mine.glsl",
                  "#include \"shaders/lib/search.glsl\"\n\nHit mine_trace(Ray ray) {\n"
                  "  Interval interval;\n  float clearance;\n  Hit hit;\n"
                  "  if (relievo_begin(ray, interval, clearance, hit)) return hit;\n" +
                      body + "}\n");
  }
  ChildResult conform(std::vector<std::string> more) const {
    std::vector<std::string> words = {"conform",
                                      "--hard-cases",
                                      (folder_ / "cases.toml").string(),
                                      "-I",
                                      (folder_ / "techniques").string(),
                                      "--backends",
                                      "vulkan",
                                      "--rays",
                                      "200"};
    words.insert(words.end(), more.begin(), more.end());
    return run_relievo(words);
  }
  TemporaryFolder folder_;
};

const std::string coarse_search =
    "  Bracket bracket;\n"
    "  if (!relievo_linear_search(ray, interval, clearance, 8, bracket)) return relievo_end_of(ray, interval);\n"
    "  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);\n";

TEST_F(ConformCli, ATechniqueThatClaimsTooMuchIsCaughtWithItsRay) {
  write_technique(coarse_search);
  const ChildResult result = conform({"--techniques", "mine,exact", "--json"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("[conform.hard-cases]"), std::string::npos) << result.err;
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("rows")) << result.out;
  int faulty = 0;
  for (const auto& row : json["rows"]) {
    EXPECT_EQ(row.contains("fault"), row["technique"] == "mine") << row;
    if (!row.contains("fault")) continue;
    ++faulty;
    EXPECT_NE(row["example"]["oracle"]["text"], row["example"]["found"]["text"]);
  }
  EXPECT_EQ(faulty, 2) << "one an address mode";
}

TEST_F(ConformCli, TheSameTechniqueWithoutTheClaimIsOnlyCounted) {
  write_technique(coarse_search, "never");
  const ChildResult result = conform({"--techniques", "mine,exact", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("rows")) << result.out;
  EXPECT_EQ(json["rows"].size(), 4u) << "two techniques, two address modes";
  for (const auto& row : json["rows"]) {
    EXPECT_FALSE(row.contains("fault")) << row;
    EXPECT_EQ(row["missed"].get<int>() + row["wrong"].get<int>() > 0, row["technique"] == "mine") << row;
  }
}

TEST_F(ConformCli, RunningOutOfStepsIsAFaultWhereTheCaseDoesNotAllowIt) {
  write_technique("  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, interval.enter);\n");
  EXPECT_EQ(conform({"--techniques", "mine"}).exit_code, 4);
  folder_.write("cases.toml", TemporaryFolder::read(folder_ / "cases.toml") + "exhausted = \"allowed\"\n");
  const ChildResult allowed = conform({"--techniques", "always"});
  EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
  EXPECT_NE(allowed.out.find("mine"), std::string::npos) << "'always' holds what claims it";
}

TEST_F(ConformCli, BadCasesAreNamedByFileAndLine) {
  write_technique(coarse_search);
  folder_.write("cases.toml", "schema = 1\n[[case]]\nnam = \"thin\"\n");
  const ChildResult result = conform({"--techniques", "exact"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("cases.toml:3:1"), std::string::npos) << result.err;
}

TEST_F(ConformCli, FuzzingCatchesAClaimThatDoesNotHold) {
  write_technique(coarse_search);
  const ChildResult result = run_relievo({"conform", "--fuzz", "8000", "--seed", "3", "--techniques", "mine,exact",
                                          "-I", (folder_ / "techniques").string(), "--backends", "vulkan", "--json"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("rows")) << result.out;
  for (const auto& row : json["rows"]) {
    EXPECT_EQ(row["unsound"] > 0, row["technique"] == "mine") << row;
    EXPECT_GE(row["calls"], 4000) << row;
    EXPECT_GE(row["judged"], 500) << row;
  }
  ASSERT_FALSE(json["findings"].empty());
  EXPECT_EQ(json["findings"][0]["technique"], "mine");
}

TEST_F(ConformCli, FuzzingReportsAJobThatTakesTooLongAndEndsWhenItDoesNotComeBack) {
  // Mesa's software drivers leave any loop after 65535 rounds: what ends for nobody else takes them a second.
  write_technique(
      "  float t = 1.0;\n  while (t > 0.0) t = relievo_height_at(ray.origin.xy + vec2(t)) + 1.0;\n"
      "  return relievo_hit_at(ray, RELIEVO_HIT, t);\n");
  const auto fuzz = [&](const char* patience) {
    return run_relievo({"conform", "--fuzz", "2000", "--techniques", "mine", "-I", (folder_ / "techniques").string(),
                        "--backends", "vulkan", "--patience", patience});
  };
  const ChildResult slow = fuzz("0.05");
  EXPECT_EQ(slow.exit_code, 4);
  const bool is_told = slow.out.find("s for 250 rays") != std::string::npos;
  EXPECT_TRUE(is_told || slow.err.find("does not come back") != std::string::npos) << slow.out << slow.err;
  const ChildResult hanging = fuzz("0.002");
  EXPECT_EQ(hanging.exit_code, 4) << hanging.out;
  EXPECT_NE(hanging.err.find("mine on vulkan in round 0 of seed 1 does not come back"), std::string::npos)
      << hanging.err;
}

}  // namespace
}  // namespace relievo::test
