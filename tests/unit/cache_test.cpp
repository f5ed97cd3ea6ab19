#include "relievo/cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <thread>

#include "support/caches.hpp"
#include "support/files.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

CacheOptions options_with(const fs::path& folder, std::uint64_t max_bytes) {
  CacheOptions options;
  options.folder = folder;
  options.max_bytes = max_bytes;
  return options;
}

std::string error_id(const CacheOptions& options) {
  const auto opened = open_cache(options);
  return opened ? "opened" : opened.error().id;
}

TEST(CacheKey, SeparatesItsParts) {
  EXPECT_NE(cache_key({"ab", "c"}), cache_key({"a", "bc"}));
  EXPECT_NE(cache_key({"ab", "c"}), cache_key({"abc"}));
  EXPECT_NE(cache_key({"", "x"}), cache_key({"x", ""}));
  EXPECT_NE(cache_key({}), cache_key({""}));
  EXPECT_EQ(cache_key({"ab", "c"}), cache_key({"ab", "c"}));
}

// A key that changes with the release or the machine would empty every cache and part every team's.
TEST(CacheKey, IsTheSameInEveryReleaseAndOnEveryMachine) {
  EXPECT_EQ(to_string(cache_key({"ab", "c"})), "f2eda2708bcfd51cc05c0ee4c9f60440");
  EXPECT_EQ(to_string(CacheKey{0x0123456789abcdefu, 0xfu}), "0123456789abcdef000000000000000f");
}

TEST(CacheFolder, IsWhatTheEnvironmentSays) {
  const auto with = [](const char* own, const char* xdg, const char* home) {
    const auto set = [](const char* name, const char* value) {
      value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
    };
    const auto kept = [](const char* name) {
      const char* value = std::getenv(name);
      return value == nullptr ? std::optional<std::string>() : std::string(value);
    };
    const auto old_own = kept("RELIEVO_CACHE_DIR"), old_xdg = kept("XDG_CACHE_HOME"), old_home = kept("HOME");
    set("RELIEVO_CACHE_DIR", own);
    set("XDG_CACHE_HOME", xdg);
    set("HOME", home);
    const std::string folder = default_cache_folder().string();
    set("RELIEVO_CACHE_DIR", old_own ? old_own->c_str() : nullptr);
    set("XDG_CACHE_HOME", old_xdg ? old_xdg->c_str() : nullptr);
    set("HOME", old_home ? old_home->c_str() : nullptr);
    return folder;
  };
  EXPECT_EQ(with("/own", "/xdg", "/home/me"), "/own");
  EXPECT_EQ(with(nullptr, "/xdg", "/home/me"), "/xdg/relievo");
  EXPECT_EQ(with("", "", "/home/me"), "/home/me/.cache/relievo");
  EXPECT_EQ(with(nullptr, "relative", "/home/me"), "/home/me/.cache/relievo");
  EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
}

TEST(CacheFolder, ThatCannotServeIsAnError) {
  const TemporaryFolder folder;
  folder.write("file", "");
  fs::create_symlink(folder / "nowhere", folder / "dangling");
  for (const fs::path& bad :
       {folder / "file", folder / "file" / "below", folder / "dangling", fs::path("/proc/relievo")}) {
    const auto opened = open_cache(options_with(bad, 1 << 20));
    ASSERT_FALSE(opened) << bad;
    EXPECT_EQ(opened.error().id, "cache.folder");
    EXPECT_EQ(opened.error().file, bad.string());
  }
  EXPECT_EQ(error_id(options_with(folder / "file", (1 << 20) - 1)), "cache.size");
}

TEST(CacheAddress, ThatIsNoneIsAnError) {
  const TemporaryFolder folder;
  CacheOptions options = options_with(folder.path(), 1 << 20);
  for (const char* bad : {"redis", "redis://", "http://host", "redis://host:", "redis://host:0", "redis://host:65536",
                          "redis://host:1x", "redis://host/x", "redis://host/-1", "redis://host/1/2", "redis://ho st",
                          "redis://user:secret@host", "redis://[::1", "redis://:6379", "redis://host:6379?x=1"}) {
    options.remote = bad;
    const auto opened = open_cache(options);
    ASSERT_FALSE(opened) << bad;
    EXPECT_EQ(opened.error().id, "cache.remote") << bad;
    EXPECT_THAT(opened.error().message, HasSubstr("expected redis://host[:port][/database]"));
    EXPECT_THAT(opened.error().message, HasSubstr(bad));
  }
  options.remote = "redis://127.0.0.1:1";
  options.remote_timeout = std::chrono::milliseconds(0);
  EXPECT_EQ(error_id(options), "cache.remote");
  options.remote_timeout = std::chrono::milliseconds(50);
  for (const char* good :
       {"redis://127.0.0.1:1", "redis://127.0.0.1:1/", "redis://127.0.0.1:1/15", "redis://[::1]:1"}) {
    options.remote = good;
    EXPECT_EQ(error_id(options), "opened") << good;
  }
}

TEST(Cache, AnswersWithTheBytesThatWereStored) {
  const TemporaryFolder folder;
  const std::vector<std::size_t> sizes = {0, 1, 7, 240, 241, 80'000, 3'000'000};
  {
    LoggedCache cache(folder / "made/anew");
    for (std::size_t size : sizes) {
      EXPECT_EQ(cache->load(numbered_key(size)), std::nullopt);
      cache->store(numbered_key(size), numbered_payload(size, size));
      EXPECT_EQ(cache->load(numbered_key(size)), numbered_payload(size, size));
    }
    const CacheCounts counts = cache->counts();
    EXPECT_EQ(counts.misses, sizes.size());
    EXPECT_EQ(counts.hits, sizes.size());
    EXPECT_EQ(counts.stores, sizes.size());
    EXPECT_EQ(counts.broken + counts.failed_stores + counts.evictions + counts.remote_hits, 0u);
    EXPECT_THAT(cache.said(), IsEmpty());
  }
  LoggedCache again(folder / "made/anew");
  for (std::size_t size : sizes) EXPECT_EQ(again->load(numbered_key(size)), numbered_payload(size, size));
}

TEST(Cache, DamagedEntryIsSaidRemovedAndMadeAnew) {
  const TemporaryFolder folder;
  LoggedCache cache(folder.path());
  cache->store(numbered_key(1), numbered_payload(1, 100));
  const fs::path file = entry_file(folder.path(), numbered_key(1));
  ASSERT_TRUE(fs::exists(file));
  fs::resize_file(file, 99);
  EXPECT_EQ(cache->load(numbered_key(1)), std::nullopt);
  EXPECT_EQ(cache->counts().broken, 1u);
  EXPECT_EQ(cache->counts().misses, 1u);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_THAT(cache.said(), ElementsAre(HasSubstr(file.string())));
  EXPECT_EQ(cache->load(numbered_key(1)), std::nullopt);
  EXPECT_EQ(cache->counts().broken, 1u);
  cache->store(numbered_key(1), numbered_payload(1, 100));
  EXPECT_EQ(cache->load(numbered_key(1)), numbered_payload(1, 100));
}

// Each would otherwise be followed, waited for, or taken for an entry.
TEST(Cache, WhatIsNoFileInAnEntrysPlaceIsAMiss) {
  const TemporaryFolder folder;
  LoggedCache cache(folder.path());
  cache->store(numbered_key(0), "stored");
  const auto place = [&](std::uint64_t number) {
    const fs::path file = entry_file(folder.path(), numbered_key(number));
    fs::create_directories(file.parent_path());
    return file;
  };
  fs::create_symlink(entry_file(folder.path(), numbered_key(0)), place(1));
  ASSERT_EQ(::mkfifo(place(2).c_str(), 0600), 0);
  fs::create_directory(place(3));
  fs::copy_file(entry_file(folder.path(), numbered_key(0)), place(4));  // sound, but another key's
  for (std::uint64_t number = 1; number <= 4; ++number) EXPECT_EQ(cache->load(numbered_key(number)), std::nullopt);
  EXPECT_EQ(cache.said().size(), 4u);
  EXPECT_EQ(cache->load(numbered_key(0)), "stored");
  EXPECT_FALSE(fs::is_symlink(fs::symlink_status(place(1))));
  cache->store(numbered_key(3), "no room");
  EXPECT_EQ(cache->counts().failed_stores, 1u);
}

TEST(Cache, GoesOnWhenItsFolderIsRemoved) {
  const TemporaryFolder folder;
  LoggedCache cache(folder / "cache");
  cache->store(numbered_key(1), "before");
  fs::remove_all(folder / "cache");
  EXPECT_EQ(cache->load(numbered_key(1)), std::nullopt);
  cache->store(numbered_key(1), "after");
  EXPECT_EQ(cache->load(numbered_key(1)), "after");
}

TEST(Cache, ServesManyThreads) {
  const TemporaryFolder folder;
  LoggedCache cache(folder.path());
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      Answers answers;
      for (std::uint64_t i = 0; i < 400; ++i) {
        cache->store(numbered_key(i % 50), numbered_payload(i % 50, 3000));
        judge(answers, *cache, (i * 7) % 50, 3000);
      }
      wrong += answers.wrong;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  const CacheCounts counts = cache->counts();
  EXPECT_EQ(counts.stores, 8u * 400u);
  EXPECT_EQ(counts.hits + counts.misses, 8u * 400u);
  EXPECT_THAT(cache.said(), IsEmpty());
}

void set_age(const fs::path& file, std::chrono::minutes age) {
  fs::last_write_time(file, fs::file_time_type::clock::now() - age);
}

TEST(CacheBound, EntriesUsedLongestAgoGoFirst) {
  const TemporaryFolder folder;
  LoggedCache cache(options_with(folder.path(), 1 << 20));
  constexpr std::size_t size = 50'000;
  for (std::uint64_t i = 0; i < 10; ++i) {
    cache->store(numbered_key(i), numbered_payload(i, size));
    set_age(entry_file(folder.path(), numbered_key(i)), std::chrono::minutes(100 - i));
  }
  EXPECT_EQ(cache->load(numbered_key(0)), numbered_payload(0, size));  // so it is used again, and stays
  for (std::uint64_t i = 100; i < 110; ++i) cache->store(numbered_key(i), numbered_payload(i, size));
  EXPECT_GT(cache->counts().evictions, 0u);
  EXPECT_LT(cache->counts().evictions, 9u);
  EXPECT_EQ(cache->load(numbered_key(0)), numbered_payload(0, size));
  EXPECT_EQ(cache->load(numbered_key(1)), std::nullopt);
  EXPECT_EQ(cache->load(numbered_key(9)), numbered_payload(9, size));
  EXPECT_EQ(cache->load(numbered_key(109)), numbered_payload(109, size));
}

TEST(CacheBound, IsKeptWhateverTheCountSays) {
  const TemporaryFolder folder;
  const auto fill = [&](std::uint64_t first) {
    LoggedCache cache(options_with(folder.path(), 1 << 20));
    for (std::uint64_t i = first; i < first + 100; ++i) {
      cache->store(numbered_key(i), numbered_payload(i, 20'000));
      EXPECT_LE(inspect_cache(folder.path())->bytes, std::uint64_t{1} << 20);
    }
    EXPECT_GT(inspect_cache(folder.path())->bytes, std::uint64_t{1} << 19);  // room is used
  };
  fill(0);
  std::string usage = TemporaryFolder::read(folder / "usage");
  ASSERT_FALSE(usage.empty());
  usage[8] = static_cast<char>(usage[8] ^ 1);
  for (const std::string& damaged : {usage, std::string(), std::string(1000, 'x'), std::string(32, '\0')}) {
    folder.write("usage", damaged);
    fill(1000 * damaged.size());
  }
  fs::remove(folder / "usage");
  fill(200);
}

TEST(CacheBound, EntryThatIsTooLargeIsNotKept) {
  const TemporaryFolder folder;
  LoggedCache cache(options_with(folder.path(), 1 << 20));
  cache->store(numbered_key(1), numbered_payload(1, 1 << 20));
  cache->store(numbered_key(2), numbered_payload(2, 1 << 20));
  EXPECT_EQ(cache->counts().failed_stores, 2u);
  EXPECT_THAT(cache.said(), ElementsAre(HasSubstr("expected at most")));
  EXPECT_EQ(cache->load(numbered_key(1)), std::nullopt);
}

TEST(CacheContents, AreCountedVerifiedAndCleared) {
  const TemporaryFolder folder;
  EXPECT_EQ(inspect_cache(folder / "absent")->entries, 0u);
  EXPECT_EQ(clear_cache(folder / "absent")->entries, 0u);
  EXPECT_FALSE(fs::exists(folder / "absent"));
  EXPECT_EQ(inspect_cache(folder.write("file", "")).error().id, "cache.folder");
  {
    LoggedCache cache(folder.path());
    for (std::uint64_t i = 0; i < 5; ++i) cache->store(numbered_key(i), numbered_payload(i, 1000));
  }
  const fs::path damaged = entry_file(folder.path(), numbered_key(3));
  const std::uint64_t entry_size = fs::file_size(damaged);
  std::string bytes = TemporaryFolder::read(damaged);
  bytes.back() ^= 1;
  std::ofstream(damaged, std::ios::binary) << bytes;
  const std::string place = damaged.parent_path() / damaged.stem();
  std::ofstream(place + ".999999999-0.tmp") << "left behind";
  std::ofstream(place + "." + std::to_string(::getpid()) + "-0.tmp") << "being written";
  std::ofstream(place + ".other") << "foreign";

  const auto seen = inspect_cache(folder.path());
  EXPECT_EQ(seen->entries, 5u);
  EXPECT_EQ(seen->bytes, 5 * entry_size);
  EXPECT_EQ(seen->unfinished, 1u);
  const auto verified = verify_cache(folder.path());
  EXPECT_EQ(verified->entries, 4u);
  EXPECT_EQ(verified->broken, 1u);
  EXPECT_FALSE(fs::exists(damaged));
  EXPECT_EQ(verify_cache(folder.path())->broken, 0u);
  const auto cleared = clear_cache(folder.path());
  EXPECT_EQ(cleared->entries, 4u);
  EXPECT_EQ(cleared->bytes, 4 * entry_size);
  EXPECT_EQ(cleared->unfinished, 1u);
  EXPECT_EQ(inspect_cache(folder.path())->entries, 0u);
  EXPECT_TRUE(fs::exists(place + ".other"));
  EXPECT_TRUE(fs::exists(folder / "file"));
  EXPECT_EQ(file_count(folder.path(), ".tmp"), 1u);  // its writer lives
}

}  // namespace
}  // namespace relievo::test
