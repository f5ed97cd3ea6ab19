/// `relievo permute` divided: shards, merging, Ninja.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "support/permute_project.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string part_name(int i, int count) {
  return "small." + std::to_string(i) + "-of-" + std::to_string(count) + ".rla";
}

/// Compiles all shards into "parts" and gives their archives.
std::vector<std::string> run_shards(const PermuteProject& project, int count, std::vector<std::string> options = {}) {
  options.insert(options.end(), {"--cache", project / "cache", "--shard", ""});
  std::vector<std::string> parts;
  for (int i = 1; i <= count; ++i) {
    options.back() = std::to_string(i) + "/" + std::to_string(count);
    const ChildResult result = project.run("parts", options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    parts.push_back(project / ("parts/" + part_name(i, count)));
  }
  return parts;
}

ChildResult merge(const PermuteProject& project, const std::vector<std::string>& parts,
                  const std::string& out = "merged") {
  std::vector<std::string> options = {"--merge"};
  options.insert(options.end(), parts.begin(), parts.end());
  return project.run(out, options);
}

TEST(PermuteShards, MergedAreTheSingleRunsBytesForAnyNumber) {
  const PermuteProject project;
  const std::string single = project.archive_of("single", {"--no-cache", "-j", "1"});
  EXPECT_EQ(project.archive_of("two", {"--no-cache", "-j", "2"}), single);
  EXPECT_EQ(project.archive_of("cold", {"--cache", project / "other"}), single);
  EXPECT_EQ(project.archive_of("warm", {"--cache", project / "other"}), single);
  for (const int count : {1, 2, 3, 7, 20}) {  // 20: more than there are programs
    const ChildResult merged = merge(project, run_shards(project, count));
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(project.archive("merged"), single) << count;
    fs::remove_all(project / "merged");
  }
}

TEST(PermuteShards, AreTheSameOnEveryRunAndWithAnyCache) {
  const PermuteProject project;
  const std::vector<std::string> parts = run_shards(project, 3);
  for (int i = 1; i <= 3; ++i) {
    const std::string name = part_name(i, 3);
    ASSERT_EQ(project.run("again", {"--no-cache", "-j", "1", "--shard", std::to_string(i) + "/3"}).exit_code, 0);
    EXPECT_EQ(TemporaryFolder::read(project / ("again/" + name)), TemporaryFolder::read(project / ("parts/" + name)));
  }
}

/// Seconds a shard by its .costs file.
std::vector<double> loads(const PermuteProject& project, int count, const std::map<std::string, double>& costs) {
  std::vector<double> sums;
  for (int i = 1; i <= count; ++i) {
    std::string name = part_name(i, count);
    name.replace(name.size() - 3, 3, "costs");
    std::istringstream text(TemporaryFolder::read(project / ("parts/" + name)));
    double sum = 0, ignored = 0;
    for (std::string closure; text >> closure >> ignored;) sum += costs.at(closure);
    sums.push_back(sum);
  }
  return sums;
}

TEST(PermuteShards, AreBalancedByMeasuredCosts) {
  const PermuteProject project;
  ASSERT_EQ(project.run("single", {"--no-cache"}).exit_code, 0);
  std::istringstream measured(TemporaryFolder::read(project / "single/small.costs"));
  std::map<std::string, double> costs;
  std::ostringstream text;
  double ignored = 0, largest = 0;
  for (std::string closure; measured >> closure >> ignored;) {
    const double seconds =
        1 + static_cast<double>(costs.size() * costs.size());  // far from what the sources' lengths say
    costs[closure] = seconds;
    largest = std::max(largest, seconds);
    text << closure << ' ' << seconds << '\n';
  }
  ASSERT_EQ(costs.size(), 16u);
  project.folder().write("given.costs", text.str());
  const auto spread = [](const std::vector<double>& sums) {
    const auto [least, most] = std::minmax_element(sums.begin(), sums.end());
    return *most - *least;
  };
  const std::vector<std::string> parts = run_shards(project, 3, {"--costs", project / "given.costs"});
  EXPECT_LE(spread(loads(project, 3, costs)), largest);
  EXPECT_EQ(merge(project, parts).exit_code, 0);
  EXPECT_EQ(project.archive("merged"), project.archive("single"));
  // The same check of shards that know no costs: it can fail.
  fs::remove_all(project / "parts");
  fs::remove_all(project / "cache");
  run_shards(project, 3);
  EXPECT_GT(spread(loads(project, 3, costs)), 0.2 * largest);
}

TEST(PermuteShards, OtherCostsMakeOtherShards) {
  const PermuteProject project;
  project.folder().write("given.costs", "");
  ASSERT_EQ(project.run("parts", {"--no-cache", "--shard", "1/2", "--costs", project / "given.costs"}).exit_code, 0);
  EXPECT_THAT(project.run("parts", {"--no-cache", "--shard", "1/2", "--costs", project / "given.costs"}).out,
              HasSubstr("is up to date"));
  project.folder().write("given.costs", "aaaa 1\n");
  EXPECT_THAT(project.run("parts", {"--no-cache", "--shard", "1/2", "--costs", project / "given.costs"}).out,
              HasSubstr("compiled"));
  const ChildResult missing = project.run("parts", {"--no-cache", "--shard", "1/2", "--costs", project / "none"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("permute.costs"));
}

class PermuteMerge : public ::testing::Test {
 protected:
  void SetUp() override {
    parts_ = run_shards(project_, 3);
    ASSERT_EQ(merge(project_, parts_).exit_code, 0);
    single_ = project_.archive("merged");
  }
  /// Merging fails with this error, and the archive that was there stays.
  void expect_refused(const std::vector<std::string>& parts, const std::string& id, const std::string& words) {
    const ChildResult result = merge(project_, parts);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("[" + id + "]"));
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_EQ(project_.archive("merged"), single_);
    EXPECT_TRUE(strays(project_ / "merged").empty());
  }
  /// The small manifest with other words for some of its own.
  void rewrite_manifest(const std::string& from, const std::string& to) {
    std::string text = small_manifest();
    text.replace(text.find(from), from.size(), to);
    project_.folder().write("relievo.toml", text);
  }
  PermuteProject project_;
  std::vector<std::string> parts_;
  std::string single_;
};

TEST_F(PermuteMerge, NamesAPermutationThatIsMissing) {
  expect_refused({parts_[0], parts_[2]}, "permute.incomplete", "of 16 permutations, the first of them technique=");
  expect_refused({parts_[1], parts_[1]}, "permute.incomplete", "of 16 permutations");
}

TEST_F(PermuteMerge, IsTheRunItself) {
  EXPECT_THAT(project_.run("merged", {"--no-cache"}).out, HasSubstr("is up to date"));
}

TEST_F(PermuteMerge, RefusesPartsOfAnotherPlan) {
  rewrite_manifest("\"glsl-450\"", "\"glsl-330\"");
  expect_refused(parts_, "permute.mixed", "run its shard again");
  for (int i = 1; i <= 3; ++i) fs::remove(project_ / ("parts/small." + std::to_string(i) + "-of-3.stamp"));
  expect_refused(parts_, "permute.mixed", "for other targets");
  rewrite_manifest("\"bump\", ", "");
  expect_refused(parts_, "permute.mixed", "other axes");
  rewrite_manifest("filter = [", "aov = [\"color\", \"normal\"]\nfilter = [");
  expect_refused(parts_, "permute.mixed", "other axes");
}

TEST_F(PermuteMerge, RefusesWhatIsNoPart) {
  fs::resize_file(parts_[1], fs::file_size(parts_[1]) / 2);
  expect_refused(parts_, "archive.format", "2-of-3");
  expect_refused({project_ / "absent.rla"}, "archive.open", "absent.rla");
}

TEST(PermuteMergeReasons, AreThoseOfAnyFolder) {
  const std::string rule =
      "[[rule]]\nwhen = { technique = \"bump\" }\nexcludes = { target = \"glsl-450\" }\nreason = \"none needed\"\n";
  const PermuteProject here(small_manifest() + rule), there(small_manifest() + rule);
  EXPECT_EQ(here.archive_of("out", {"--no-cache"}), there.archive_of("out", {"--no-cache"}));
  EXPECT_THAT(here.archive("out"), HasSubstr("none needed (relievo.toml:"));
}

/// Runs Ninja from another folder; its output, or why it failed.
std::string ninja(const std::string& folder, int expected_code = 0) {
  const ChildResult result = run_child("/usr/bin/ninja", {"-C", folder});
  EXPECT_EQ(result.exit_code, expected_code) << result.out << result.err;
  return result.out;
}

class PermuteNinja : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path source = RELIEVO_SOURCE_DIR "/tests/support/template_technique";
    for (const char* name : {"one", "two"}) {
      fs::create_directories(project_ / "techniques");
      fs::copy(source, project_ / ("techniques/" + std::string(name)), fs::copy_options::recursive);
      rename_technique(name);
    }
    fs::remove_all(project_ / "techniques/two/maps");
  }
  /// The copy is called by its folder's name; its map stays the same.
  void rename_technique(const std::string& name) {
    const std::string folder = project_ / ("techniques/" + name + "/");
    fs::rename(folder + "template_technique.glsl", folder + name + ".glsl");
    for (const std::string& file : {name + ".glsl", std::string("biased.glsl"), std::string("technique.toml")}) {
      std::string text = TemporaryFolder::read(folder + file);
      for (std::size_t at = 0; (at = text.find("template_technique", at)) != std::string::npos;)
        text.replace(at, 18, name);
      std::ofstream(folder + file) << text;
    }
  }
  void append(const std::string& file, const std::string& text) const {
    std::ofstream(project_ / file, std::ios::app) << text;
  }
  std::string emit(const std::vector<std::string>& more) const {
    std::vector<std::string> options = {"--emit", "ninja", "--cache", project_ / "a cache"};
    options.insert(options.end(), more.begin(), more.end());
    const ChildResult result = project_.run(out_, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return project_ / out_;
  }
  const std::string out_ = "it's $a folder: #1";
  const PermuteProject project_{[] {
    std::string text = small_manifest("folders = [\"techniques\"]\n");
    const std::string_view relief = "\"relief\"";
    return text.replace(text.find(relief), relief.size(), "\"relief\", \"one\"");
  }()};
};

TEST_F(PermuteNinja, MakesTheSingleRunsArchiveOnce) {
  const std::string folder = emit({"--shards", "3"});
  EXPECT_THAT(ninja(folder), HasSubstr("[4/4]"));
  EXPECT_EQ(project_.archive(out_), project_.archive_of("single", {"--no-cache"}));
  EXPECT_THAT(ninja(folder), HasSubstr("no work to do"));
}

TEST_F(PermuteNinja, RunsAgainForWhatIsUsedOnly) {
  const std::string folder = emit({"--shards", "2"});
  ninja(folder);
  append("techniques/two/two.glsl", "// nobody uses this technique\n");
  EXPECT_THAT(ninja(folder), HasSubstr("no work to do"));
  append("techniques/one/biased.glsl", "float one_more() { return 1.0; }\n");  // an #include of an #include
  EXPECT_THAT(ninja(folder), HasSubstr("[3/3]"));
  EXPECT_EQ(project_.archive(out_), project_.archive_of("single", {"--no-cache"}));
  EXPECT_THAT(ninja(folder), HasSubstr("no work to do"));
}

TEST_F(PermuteNinja, RemembersItsFilesWhenNothingHasChanged) {
  const std::string folder = emit({"--shards", "2"});
  ninja(folder);
  append("relievo.toml", "");
  fs::last_write_time(project_ / "relievo.toml", fs::file_time_type::clock::now());
  const std::string touched = ninja(folder);  // both shards are up to date, and so the merge
  EXPECT_THAT(touched, HasSubstr("is up to date"));
  EXPECT_THAT(touched, ::testing::Not(HasSubstr("merge")));
  EXPECT_THAT(ninja(folder), HasSubstr("no work to do"));
  append("techniques/one/one.glsl", "float one_else() { return 1.0; }\n");
  EXPECT_THAT(ninja(folder), HasSubstr("[3/3]"));
}

TEST_F(PermuteNinja, KeepsTheOldArchiveWhenATechniqueIsBroken) {
  const std::string folder = emit({"--shards", "2"});
  ninja(folder);
  const std::string old = project_.archive(out_);
  append("techniques/one/one.glsl", "float broken( {\n");
  EXPECT_THAT(ninja(folder, 1), HasSubstr("techniques/one/one.glsl:17:"));
  EXPECT_EQ(project_.archive(out_), old);
}

TEST_F(PermuteNinja, PassesCostsAndRefusesNamesThatNinjaCannotHave) {
  ASSERT_EQ(project_.run("single", {"--no-cache"}).exit_code, 0);
  const std::string folder = emit({"--shards", "2", "--costs", project_ / "single/small.costs"});
  fs::remove(project_ / "single/small.costs");  // the shards have a copy
  ninja(folder);
  EXPECT_EQ(project_.archive(out_), project_.archive("single"));
  const ChildResult bad = project_.run("two\nlines", {"--emit", "ninja"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("permute.emit"));
}

}  // namespace
}  // namespace relievo::test
