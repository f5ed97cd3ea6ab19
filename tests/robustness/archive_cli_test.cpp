// relievo archive list, find, verify and merge, as a user calls them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/archives.hpp"
#include "support/child.hpp"

namespace relievo {
namespace {

using test::ChildResult;
using test::run_relievo;
using test::sample_archive;
using test::TemporaryFolder;
using testing::HasSubstr;

class ArchiveCli : public testing::Test {
 protected:
  void SetUp() override { test::write_archive(file_, sample_archive()); }

  ChildResult find(std::vector<std::string> rest) const {
    rest.insert(rest.begin(), {"archive", "find", file_});
    return run_relievo(rest);
  }

  const TemporaryFolder folder_;
  const std::string file_ = (folder_ / "a.rva").string();
};

TEST_F(ArchiveCli, ListsAxesTargetsAndCounts) {
  const ChildResult text = run_relievo({"archive", "list", file_, "--permutations"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("8 permutations, 5 programs"));
  EXPECT_THAT(text.out, HasSubstr("axis technique: bump, relief, cone (default bump)"));
  EXPECT_THAT(text.out, HasSubstr("absent from 4 permutations"));
  EXPECT_THAT(text.out, HasSubstr("technique=relief address=clamp steps=8 program"));
  const auto json = nlohmann::json::parse(run_relievo({"archive", "list", file_, "--json"}).out);
  EXPECT_EQ(json["permutations"], 8);
  EXPECT_EQ(json["axes"][2]["default"], "16");
  EXPECT_EQ(json["targets"]["msl-2.2"]["absent"], 4);
  EXPECT_EQ(json["targets"]["glsl-450"]["shaders"], 10);
  EXPECT_EQ(json["bytes"], std::filesystem::file_size(file_));
}

TEST_F(ArchiveCli, FindsAPermutationAndSaysWhatItHas) {
  const ChildResult text = find({"technique=relief", "steps=8"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("technique=relief steps=8"));
  EXPECT_THAT(text.out, HasSubstr("no msl-2.2: geometry shaders are not in MSL"));
  const auto json = nlohmann::json::parse(find({"technique=cone", "--json"}).out);
  EXPECT_EQ(json["outputs"].size(), 5u);
  EXPECT_EQ(json["reflection"]["name"], "cone_repeat");
  EXPECT_EQ(json["values"]["steps"], "16");
}

TEST_F(ArchiveCli, ExtractsAShader) {
  const std::string expected = test::sample_program("relief8").outputs[3].bytes;
  const std::vector<std::string> which = {"technique=relief", "steps=8", "--target", "glsl-450", "--stage", "fragment"};
  EXPECT_EQ(find(which).out, expected);
  std::vector<std::string> to_file = which;
  to_file.insert(to_file.end(), {"-o", (folder_ / "out.glsl").string()});
  EXPECT_EQ(find(to_file).exit_code, 0);
  EXPECT_EQ(TemporaryFolder::read(folder_ / "out.glsl"), expected);
}

TEST_F(ArchiveCli, AnswersWithTheNearestAndExitCodeOne) {
  const ChildResult missing = find({"technique=cone", "steps=8"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("no permutation technique=cone steps=8; nearest: "));
  EXPECT_THAT(missing.err, HasSubstr("technique=cone (differs in steps: 16)"));
  EXPECT_THAT(missing.err, HasSubstr("[archive.missing]"));
}

TEST_F(ArchiveCli, SaysWhyATargetIsAbsent) {
  const ChildResult absent = find({"technique=relief", "--target", "msl-2.2", "--stage", "fragment"});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_THAT(absent.err, HasSubstr("use prism_pulled"));
}

TEST_F(ArchiveCli, RefusesWhatItDoesNotUnderstand) {
  EXPECT_THAT(find({"relief"}).err, HasSubstr("expected axis=value"));
  EXPECT_THAT(find({"--target", "glsl-450"}).err, HasSubstr("--stage is missing; the program has vertex, fragment"));
  EXPECT_THAT(find({"--target", "glsl-450", "--stage", "pixel"}).err, HasSubstr("--stage pixel is none"));
  EXPECT_THAT(find({"--target", "glsl-45"}).err, HasSubstr("did you mean 'glsl-450'?"));
  EXPECT_EQ(find({"--stage", "vertex"}).exit_code, 1);
  EXPECT_EQ(run_relievo({"archive", "list", (folder_ / "none").string()}).exit_code, 1);
  EXPECT_EQ(run_relievo({"archive"}).exit_code, 1);
}

TEST_F(ArchiveCli, VerifiesAndSeesDamage) {
  const ChildResult intact = run_relievo({"archive", "verify", file_});
  EXPECT_EQ(intact.exit_code, 0);
  EXPECT_EQ(intact.out, "8 permutations, 5 programs: intact\n");
  std::string bytes = TemporaryFolder::read(file_);
  bytes[bytes.find("gl_Position")] = 'h';
  const ChildResult damaged = run_relievo({"archive", "verify", folder_.write("b.rva", bytes).string()});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_THAT(damaged.err, HasSubstr("[archive.damaged]"));
}

TEST_F(ArchiveCli, MergesParts) {
  test::SampleArchive one = sample_archive(), two = one;
  one.permutations.resize(3);
  two.permutations.erase(two.permutations.begin(), two.permutations.begin() + 3);
  const std::string first = (folder_ / "1").string(), second = (folder_ / "2").string(), all = (folder_ / "3").string();
  test::write_archive(first, one);
  test::write_archive(second, two);
  const ChildResult merged = run_relievo({"archive", "merge", second, first, "-o", all});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(TemporaryFolder::read(all), TemporaryFolder::read(file_));
}

}  // namespace
}  // namespace relievo
