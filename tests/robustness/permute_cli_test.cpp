/// `relievo permute` where it does not simply compile: --list, --dry-run, --explain, --sources and --keep-going.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "relievo/archive.hpp"
#include "support/permute_project.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The small manifest, in which a rule takes 4 of 16 permutations.
std::string ruled_manifest() {
  return small_manifest() +
         "[[rule]]\nwhen = {technique = \"relief\"}\nexcludes = {address = \"clamp\"}\nreason = \"cliffs repeat\"\n";
}

class PermuteCli : public ::testing::Test {
 protected:
  ChildResult run(const std::vector<std::string>& more) const { return project_.run("out", more); }
  nlohmann::json json_of(std::vector<std::string> more) const {
    more.push_back("--json");
    const ChildResult result = run(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  /// The keys of what is kept for at least one target.
  std::set<std::string> kept_keys() const {
    std::set<std::string> keys;
    for (const auto& permutation : json_of({"--list"})) {
      if (permutation["pruned"].size() < 2) keys.insert(permutation["key"]);
    }
    return keys;
  }
  PermuteProject project_{ruled_manifest()};
};

TEST_F(PermuteCli, ListSaysOfEachPermutationWhetherItIsKept) {
  const ChildResult result = run({"--list"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  int kept = 0, pruned = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool is_pruned = line.find(" pruned ") != std::string::npos;
    EXPECT_NE(is_pruned, line.find(" kept ") != std::string::npos) << line;
    const bool is_excluded =
        line.find("technique=relief") != std::string::npos && line.find("address=clamp") != std::string::npos;
    EXPECT_EQ(is_pruned, is_excluded) << line;
    ++(is_pruned ? pruned : kept);
  }
  EXPECT_EQ(kept, 12);
  EXPECT_EQ(pruned, 4);
  const nlohmann::json list = json_of({"--list"});
  ASSERT_EQ(list.size(), 16U);
  EXPECT_EQ(kept_keys().size(), 12U);
  for (const auto& permutation : list) {
    for (const auto& [target, reason] : permutation["pruned"].items())
      EXPECT_THAT(reason.get<std::string>(), HasSubstr("cliffs repeat")) << target;
  }
  EXPECT_FALSE(fs::exists(project_ / "out"));
}

TEST_F(PermuteCli, DryRunCountsAndCompilesNothing) {
  const ChildResult result = run({"--dry-run"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("16 permutations asked for 2 targets, 12 kept for at least one; 24 outputs\n"));
  EXPECT_THAT(result.out, HasSubstr("pruned 8 times: "));
  const nlohmann::json counts = json_of({"--dry-run"});
  EXPECT_EQ(counts["asked"], 16);
  EXPECT_EQ(counts["kept"], 12);
  EXPECT_EQ(counts["outputs"], 24);
  ASSERT_EQ(counts["pruned_by"].size(), 1U);
  EXPECT_THAT(counts["pruned_by"].items().begin().key(), HasSubstr("cliffs repeat"));
  EXPECT_EQ(counts["pruned_by"].items().begin().value(), 8);
  EXPECT_FALSE(fs::exists(project_ / "out"));
}

TEST_F(PermuteCli, ExplainGivesTheReasonOfOnePermutation) {
  const ChildResult pruned = run({"--explain", "technique=relief", "address=clamp", "filter=exact"});
  EXPECT_EQ(pruned.exit_code, 0) << pruned.err;
  EXPECT_THAT(pruned.out, HasSubstr("cliffs repeat"));
  const ChildResult kept = run({"--explain", "technique=relief", "address=repeat", "filter=exact"});
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_THAT(kept.out, Not(HasSubstr("cliffs repeat")));
  EXPECT_EQ(
      json_of({"--explain", "technique=relief", "address=repeat", "filter=exact"})["explanation"].get<std::string>() +
          "\n",
      kept.out);
  const ChildResult none = run({"--explain", "relief"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("[permute.explain]"));
}

TEST_F(PermuteCli, SourcesAreThoseOfWhatIsKeptOrOfASample) {
  const auto folders = [&](const std::string& name) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(project_ / name)) {
      names.insert(entry.path().filename());
      std::set<std::string> files;
      for (const auto& file : fs::directory_iterator(entry.path())) {
        files.insert(file.path().filename());
        EXPECT_THAT(TemporaryFolder::read(file.path()), HasSubstr("#version 450")) << file.path();
      }
      EXPECT_EQ(files, (std::set<std::string>{"fragment.frag", "vertex.vert"})) << entry.path();
    }
    return names;
  };
  const std::set<std::string> kept = kept_keys();
  ASSERT_EQ(run({"--sources", project_ / "all"}).exit_code, 0);
  EXPECT_EQ(folders("all"), kept);
  ASSERT_EQ(run({"--sources", project_ / "some", "--sample", "5"}).exit_code, 0);
  const std::set<std::string> some = folders("some");
  EXPECT_EQ(some.size(), 5U);
  EXPECT_TRUE(std::includes(kept.begin(), kept.end(), some.begin(), some.end()));
  EXPECT_FALSE(fs::exists(project_ / "out")) << "nothing is compiled";
}

TEST(PermuteKeepGoing, ArchivesWhatCompilesAndFailsAllTheSame) {
  std::string manifest = small_manifest("folders = [\"mine\"]\n");
  manifest.replace(manifest.find("\"bump\""), 6, "\"bump\", \"broken\"");
  const PermuteProject project(manifest);
  fs::create_directories(project / "mine/broken");
  project.folder().write("mine/broken/technique.toml",
                         "schema = 1\nname = \"broken\"\ntitle = \"Broken\"\nclass = \"unsafe\"\n"
                         "first_hit = \"never\"\nmodule = \"broken.glsl\"\n");
  project.folder().write("mine/broken/broken.glsl", "Hit broken_trace(Ray ray) { return nothing; }\n");

  const ChildResult stopped = project.run("stopped", {"--no-cache"});
  EXPECT_EQ(stopped.exit_code, 2) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("no archive is written"));
  EXPECT_FALSE(fs::exists(project / "stopped/small.rla"));

  const ChildResult went_on = project.run("out", {"--no-cache", "--keep-going"});
  EXPECT_EQ(went_on.exit_code, 2) << went_on.err;
  EXPECT_THAT(went_on.err, HasSubstr("broken.glsl:1"));
  EXPECT_THAT(went_on.err, HasSubstr("[permute.failed]"));
  EXPECT_THAT(went_on.err, HasSubstr("4 of 20 permutations did not compile; the archive lacks them"));
  const auto archive = Archive::open(project / "out/small.rla");
  ASSERT_TRUE(archive) << format(archive.error());
  EXPECT_EQ(archive->size(), 16U);
  EXPECT_TRUE(archive->verify());
  for (Archive::Entry entry = 0; entry < archive->size(); ++entry)
    EXPECT_THAT(archive->name(entry), Not(HasSubstr("broken")));
}

}  // namespace
}  // namespace relievo::test
