/// `relievo permute` killed, doubled, without room, on a damaged cache: the archive is right or the old one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "support/caches.hpp"
#include "support/damage.hpp"
#include "support/permute_project.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::microseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Every cache entry, sorted, so that random picks repeat.
std::vector<fs::path> entries_of(const std::string& cache) {
  std::vector<fs::path> entries;
  for (const auto& file : fs::recursive_directory_iterator(cache)) {
    if (file.path().extension() == ".entry") entries.push_back(file.path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// How the runs ended, and what they left: stray files at most after one, and after the whole runs that followed.
struct Killings {
  int killed = 0, finished = 0, wrong = 0, most_strays = 0, left_strays = 0, torn = 0;
};

/// Takes some of the cache away, so that a run compiles and stores again.
void forget_some(const std::string& cache, std::mt19937& random) {
  if (!fs::exists(cache)) return;
  for (const fs::path& entry : entries_of(cache)) {
    if (random() % 4 == 0) fs::remove(entry);
  }
}

Killings kill_runs(int times, const std::string& expected) {
  const PermuteProject project;
  const std::string cache = project / "cache";
  const std::vector<std::string> options = {"--cache", cache, "-j", "2", "--force"};
  const auto started = std::chrono::steady_clock::now();
  EXPECT_EQ(project.archive_of("out", options), expected);
  auto longest = std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - started).count();
  std::mt19937 random(11);
  Killings sum;
  for (int i = 0; i < times; ++i) {
    forget_some(cache, random);
    const bool is_new = i % 2 == 0;  // every other time there is no archive to keep
    if (is_new) fs::remove_all(project / "out");
    const std::string before = project.archive("out");
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = project.start("out", options);
    std::this_thread::sleep_for(microseconds(random() % static_cast<unsigned>(longest)));
    ::kill(child, SIGKILL);
    const bool finished = end_of_run(child) == 0;
    if (finished) {  // aim at the time that a run now takes
      longest = std::min<long>(
          longest, std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - start).count());
    }
    sum.finished += finished ? 1 : 0;
    sum.killed += finished ? 0 : 1;
    const std::string left = project.archive("out");
    if (left != expected && left != before) ++sum.torn;
    sum.most_strays = std::max(sum.most_strays, static_cast<int>(strays(project / "out").size()));
    if (i % 8 != 7) continue;
    if (project.archive_of("out", options) != expected) ++sum.wrong;
    sum.left_strays += static_cast<int>(strays(project / "out").size());
  }
  std::printf(
      "%d runs killed, %d finished before: %d torn archives, %d wrong archives in the runs after; at most %d "
      "unfinished files, %d after the next run\n",
      sum.killed, sum.finished, sum.torn, sum.wrong, sum.most_strays, sum.left_strays);
  EXPECT_TRUE(clear_cache(cache));
  EXPECT_EQ(file_count(cache, ".tmp"), 0u);
  return sum;
}

void expect_no_harm(const Killings& killings, int times) {
  EXPECT_GT(killings.killed, times / 4);
  EXPECT_EQ(killings.torn, 0);
  EXPECT_EQ(killings.wrong, 0);
  EXPECT_EQ(killings.left_strays, 0);
}

std::string right_archive() {
  return PermuteProject().archive_of("out", {"--no-cache"});
}

TEST(PermuteKill, KilledRunsLeaveNoArchiveOrTheOldOne) {
  expect_no_harm(kill_runs(32, right_archive()), 32);
}

TEST(LongPermuteKill, TwoThousandKilledRuns) {
  expect_no_harm(kill_runs(2000, right_archive()), 2000);
}

TEST(PermuteKill, WhatKilledRunsLeftIsSweptAndWhatIsBeingWrittenIsNot) {
  const PermuteProject project;
  fs::create_directories(project / "out");
  for (const char* name : {"small.rla.1f-2a-0.tmp", "small.rla.1f-2a-1.spool", "small.stamp.1f-2a-0.tmp",
                           "small.rla.bak", "other.rla.1f-2a-0.tmp"})
    project.folder().write(std::string("out/") + name, "left");
  const std::string held = project.folder().write("out/small.rla.1f-2a-2.tmp", "held");
  const int writer = ::open(held.c_str(), O_RDWR);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  EXPECT_FALSE(project.archive_of("out", {"--no-cache"}).empty());
  EXPECT_THAT(strays(project / "out"),
              ::testing::UnorderedElementsAre("small.rla.bak", "other.rla.1f-2a-0.tmp", "small.rla.1f-2a-2.tmp"));
  ::close(writer);
  EXPECT_FALSE(project.archive_of("out", {"--no-cache", "--force"}).empty());
  EXPECT_FALSE(fs::exists(held));
}

TEST(PermuteKill, RunsAtOnceOnOneCacheAndFolderMakeTheSameArchive) {
  const std::string expected = right_archive();
  const PermuteProject project;
  for (int round = 0; round < 4; ++round) {
    std::vector<pid_t> runs;
    for (int i = 0; i < 3; ++i)
      runs.push_back(project.start("out", {"--cache", project / "cache", "-j", "1", "--force"}));
    for (const pid_t run : runs) EXPECT_EQ(end_of_run(run), 0) << project.messages();
    EXPECT_EQ(project.archive("out"), expected);
    EXPECT_THAT(strays(project / "out"), IsEmpty());
    if (round % 2 == 0) fs::remove_all(project / "cache");
  }
}

TEST(PermuteKill, FileSizeLimitIsSaidOnceAndLeavesTheOldArchive) {
  const PermuteProject project;
  const std::string expected = right_archive();
  for (const rlim_t limit : {1000, 100'000, 600'000}) {
    for (const bool has_old : {false, true}) {
      fs::remove_all(project / "out");
      fs::create_directories(project / "out");
      if (has_old) project.folder().write("out/small.rla", expected);
      const pid_t run = project.start("out", {"--no-cache", "--force"}, limit);
      EXPECT_EQ(end_of_run(run), 1) << project.messages();
      EXPECT_THAT(project.messages(), HasSubstr("cannot be written: File too large"));
      EXPECT_EQ(project.messages().find("error:"), project.messages().rfind("error:"));
      EXPECT_EQ(project.archive("out"), has_old ? expected : "");
      EXPECT_THAT(strays(project / "out"), IsEmpty());
    }
  }
  EXPECT_EQ(end_of_run(project.start("out", {"--no-cache", "--force"})), 0);  // the limit it was
}

TEST(PermuteKill, CacheThatCannotGrowCostsNoArchive) {
  const PermuteProject project;
  const std::string expected = right_archive();
  fs::create_directories(project / "cache");
  project.folder().write("cache/usage", "damaged");
  EXPECT_EQ(project.archive_of("out", {"--cache", project / "cache", "--cache-size", "1"}), expected);
}

struct Corruptions {
  int entries = 0, wrong = 0, failed = 0;
};

/// Damages cache entries, `each` before every run, until there were `times`.
Corruptions corrupt_cache(int times, unsigned each, const std::string& expected) {
  const PermuteProject project;
  const std::string cache = project / "cache";
  const std::vector<std::string> options = {"--cache", cache, "--force"};
  project.archive_of("out", options);
  std::mt19937 random(23);
  Corruptions sum;
  while (sum.entries < times) {
    const std::vector<fs::path> entries = entries_of(cache);
    for (unsigned i = 0; i < each; ++i, ++sum.entries) {
      const fs::path& entry = entries[random() % entries.size()];
      const std::string bytes = damaged(TemporaryFolder::read(entry), random);
      std::ofstream(entry, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    const ChildResult result = project.run("out", options);
    sum.failed += result.exit_code != 0 ? 1 : 0;
    sum.wrong += project.archive("out") != expected ? 1 : 0;
  }
  std::printf("%d corruptions of cache entries: %d runs failed, %d archives were wrong\n", sum.entries, sum.failed,
              sum.wrong);
  return sum;
}

TEST(PermuteKill, CorruptedCacheGivesTheSameArchive) {
  const Corruptions corruptions = corrupt_cache(100, 10, right_archive());
  EXPECT_EQ(corruptions.failed + corruptions.wrong, 0);
}

TEST(LongPermuteKill, TenThousandCorruptionsOfTheCache) {
  const Corruptions corruptions = corrupt_cache(10'000, 10, right_archive());
  EXPECT_EQ(corruptions.failed + corruptions.wrong, 0);
}

}  // namespace
}  // namespace relievo::test
