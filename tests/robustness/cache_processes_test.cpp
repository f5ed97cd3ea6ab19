/// Several processes on one folder, some of them killed, some without room.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "support/caches.hpp"
#include "support/files.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::microseconds;

/// A child that runs `work` and ends with what it returns.
template <class Work>
pid_t in_child(Work work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int code = 99;
  try {
    code = work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  ::_exit(code);
}

/// Its exit code; −1 when a signal ended it.
int end_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

constexpr std::size_t kSize = 80'000;
constexpr std::uint64_t kKeys = 16;

CacheOptions options_with(const fs::path& folder, std::uint64_t max_bytes) {
  CacheOptions options;
  options.folder = folder;
  options.max_bytes = max_bytes;
  return options;
}

Answers judge_all(Cache& cache) {
  Answers answers;
  for (std::uint64_t i = 0; i < kKeys; ++i) judge(answers, cache, i, kSize);
  return answers;
}

TEST(CacheProcesses, ReaderDuringWritesSeesWholeEntries) {
  const TemporaryFolder folder;
  const pid_t writer = in_child([&] {
    LoggedCache cache(folder.path());
    for (std::uint64_t i = 0; i < 2000; ++i) cache->store(numbered_key(i % kKeys), numbered_payload(i % kKeys, kSize));
    return static_cast<int>(cache->counts().failed_stores);
  });
  LoggedCache cache(folder.path());
  Answers answers;
  int status = 0;
  while (::waitpid(writer, &status, WNOHANG) == 0) {
    for (std::uint64_t i = 0; i < kKeys; ++i) judge(answers, *cache, i, kSize);
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_GT(answers.right, 100);
  EXPECT_EQ(answers.wrong, 0);
  EXPECT_EQ(cache->counts().broken, 0u);
}

/// How a writer puts its bytes into the cache.
using Store = void (*)(Cache& cache, const fs::path& folder, std::uint64_t number);

void store_whole(Cache& cache, const fs::path&, std::uint64_t number) {
  cache.store(numbered_key(number), numbered_payload(number, kSize));
}

/// Kills a writer at a random moment after it has begun.
void kill_one_writer(const fs::path& folder, Store store, std::mt19937& random) {
  int started[2];
  ASSERT_EQ(::pipe(started), 0);
  const pid_t writer = in_child([&] {
    LoggedCache cache(options_with(folder, 1 << 20));  // so that evictions are interrupted as well
    (void)!::write(started[1], "x", 1);
    for (std::uint64_t i = 0;; ++i) store(*cache, folder, i % kKeys);
    return 0;
  });
  char byte = 0;
  ASSERT_EQ(::read(started[0], &byte, 1), 1);
  std::this_thread::sleep_for(microseconds(random() % 6000));
  ::kill(writer, SIGKILL);
  EXPECT_EQ(end_of(writer), -1);
  ::close(started[0]);
  ::close(started[1]);
}

struct Killings {
  Answers answers;
  std::uint64_t broken = 0;
  int cut_off = 0;  ///< kills that left an unfinished file
};

Killings kill_writers(int times, Store store) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  Killings killings;
  for (int i = 0; i < times; ++i) {
    const std::uint64_t before = inspect_cache(folder.path())->unfinished;
    kill_one_writer(folder.path(), store, random);
    killings.cut_off += inspect_cache(folder.path())->unfinished > before ? 1 : 0;
    LoggedCache cache(options_with(folder.path(), 1 << 20));
    const Answers answers = judge_all(*cache);
    killings.answers.right += answers.right;
    killings.answers.none += answers.none;
    killings.answers.wrong += answers.wrong;
    killings.broken += cache->counts().broken;
    EXPECT_LE(inspect_cache(folder.path())->bytes, std::uint64_t{1} << 20);
  }
  EXPECT_TRUE(clear_cache(folder.path()));
  EXPECT_EQ(file_count(folder.path(), ".tmp"), 0u);
  std::printf(
      "%d writers killed: %d right answers, %d misses, %d wrong, %d broken entries; %d were cut off while they wrote\n",
      times, killings.answers.right, killings.answers.none, killings.answers.wrong, static_cast<int>(killings.broken),
      killings.cut_off);
  return killings;
}

void expect_no_harm(const Killings& killings) {
  EXPECT_GT(killings.answers.right, 0);
  EXPECT_EQ(killings.answers.wrong, 0);
  EXPECT_EQ(killings.broken, 0u);
}

TEST(CacheProcesses, KilledWritersLeaveWholeEntries) {
  expect_no_harm(kill_writers(40, &store_whole));
}
TEST(LongCacheProcesses, TwoThousandKilledWritersLeaveWholeEntries) {
  const Killings killings = kill_writers(2000, &store_whole);
  expect_no_harm(killings);
  EXPECT_GT(killings.cut_off, 0);
}

/// Writes in place, as a cache without temporary files does.
void store_in_place(Cache& cache, const fs::path& folder, std::uint64_t number) {
  store_whole(cache, folder, number);
  const fs::path file = entry_file(folder, numbered_key(number));
  const std::string bytes = TemporaryFolder::read(file);
  std::ofstream written(file, std::ios::binary | std::ios::trunc);
  for (std::size_t at = 0; at < bytes.size(); at += 4000) written << bytes.substr(at, 4000) << std::flush;
}

TEST(CacheProcesses, WriterInPlaceIsCaughtByTheSameKills) {
  // Whether a kill hits while the file is half written is a matter of luck.
  std::uint64_t broken = 0;
  for (int round = 0; round < 20 && broken == 0; ++round) {
    const Killings killings = kill_writers(20, &store_in_place);
    EXPECT_EQ(killings.answers.wrong, 0);
    broken = killings.broken;
  }
  EXPECT_GT(broken, 0u);
}

TEST(CacheProcesses, BoundIsKeptUnderConcurrentWriters) {
  const TemporaryFolder folder;
  constexpr std::uint64_t bound = 4 << 20;
  std::vector<pid_t> writers;
  for (std::uint64_t w = 0; w < 4; ++w) {
    writers.push_back(in_child([&] {
      LoggedCache cache(options_with(folder.path(), bound));
      Answers answers;
      for (std::uint64_t i = 0; i < 500; ++i) {
        cache->store(numbered_key(1000 * w + i), numbered_payload(1000 * w + i, 40'000));
        judge(answers, *cache, 1000 * ((w + 1) % 4) + i, 40'000);
      }
      const CacheCounts counts = cache->counts();
      return counts.failed_stores == 0 && counts.broken == 0 && answers.wrong == 0 && counts.evictions > 0 ? 0 : 1;
    }));
  }
  std::uint64_t most = 0;
  for (const pid_t writer : writers) {
    int status = 0;
    while (::waitpid(writer, &status, WNOHANG) == 0) most = std::max(most, inspect_cache(folder.path())->bytes);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  std::printf("80 MB through a folder of %d bytes: at most %d lay in it\n", static_cast<int>(bound),
              static_cast<int>(most));
  EXPECT_LE(most, bound);
  EXPECT_GT(most, bound / 2);
}

// A process that was stopped while it held the count's lock must not hold up the others for ever.
TEST(CacheProcesses, StoppedHolderOfTheLockIsPassedBy) {
  const TemporaryFolder folder;
  LoggedCache cache(folder.path());
  cache->store(numbered_key(1), "makes the count");
  cache.close();
  int locked[2];
  ASSERT_EQ(::pipe(locked), 0);
  const pid_t holder = in_child([&] {
    const int fd = ::open((folder / "usage").c_str(), O_RDWR | O_CLOEXEC);
    if (::flock(fd, LOCK_EX) != 0) return 1;
    (void)!::write(locked[1], "x", 1);
    return ::pause();
  });
  char byte = 0;
  ASSERT_EQ(::read(locked[0], &byte, 1), 1);
  LoggedCache other(folder.path());
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < 20; ++i) other->store(numbered_key(i), numbered_payload(i, 1000));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
  EXPECT_EQ(other->load(numbered_key(7)), numbered_payload(7, 1000));
  ::kill(holder, SIGKILL);
  EXPECT_EQ(end_of(holder), -1);
  ::close(locked[0]);
  ::close(locked[1]);
}

/// Stores a small entry and three that have no room; 0 when all went as it should.
int store_without_room(const fs::path& folder) {
  LoggedCache cache(folder);
  cache->store(numbered_key(0), numbered_payload(0, 100));
  const std::uint64_t large = 3 << 20;
  for (std::uint64_t i = 1; i <= 3; ++i) cache->store(numbered_key(i), numbered_payload(i, large));
  for (std::uint64_t i = 1; i <= 3; ++i) {
    if (cache->load(numbered_key(i))) return 1;
  }
  if (cache->load(numbered_key(0)) != numbered_payload(0, 100)) return 2;
  if (cache->counts().failed_stores != 3 || cache->counts().stores != 1) return 3;
  if (cache.said().size() != 1) return 4;
  if (file_count(folder, ".tmp") != 0 || file_count(folder, ".entry") != 1) return 5;
  return 0;
}

TEST(CacheProcesses, FileSizeLimitIsSaidOnceAndLeavesNothing) {
  const TemporaryFolder folder;
  const pid_t child = in_child([&] {
    const rlimit limit{1 << 20, 1 << 20};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 90;
    return store_without_room(folder.path());
  });
  EXPECT_EQ(end_of(child), 0);
  EXPECT_EQ(store_without_room(folder / "with room"), 1);  // the check can fail
}

TEST(CacheProcesses, FullDiskIsSaidOnceAndLeavesNothing) {
  const TemporaryFolder folder;
  const pid_t child = in_child([&] {
    if (::unshare(CLONE_NEWNS) != 0 || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("none", folder.path().c_str(), "tmpfs", 0, "size=2m") != 0)
      return 77;
    return store_without_room(folder.path());
  });
  const int code = end_of(child);
  if (code == 77) std::printf("no small disk can be mounted here; the file size limit alone is tested\n");
  EXPECT_THAT(code, ::testing::AnyOf(0, 77));
}

TEST(CacheProcesses, FolderThatMayNotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "closed");
  fs::permissions(folder / "closed", fs::perms(0555));
  const pid_t child = in_child([&] {
    if (::geteuid() == 0 && ::setresuid(65534, 65534, 65534) != 0) return 90;
    for (const fs::path& place : {folder / "closed", folder / "closed/below"}) {
      const auto opened = open_cache(options_with(place, 1 << 20));
      if (opened || opened.error().id != "cache.folder") return 1;
    }
    return 0;
  });
  EXPECT_EQ(end_of(child), 0);
}

}  // namespace
}  // namespace relievo::test
