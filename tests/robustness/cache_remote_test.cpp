/// A cache behind which a Redis server stands, falls, stops or talks nonsense.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/caches.hpp"
#include "support/redis_server.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kSize = 80'000;
constexpr milliseconds kTimeout{600};
constexpr milliseconds kSlack{500};  // for a machine that has other things to do; two timeouts are more

CacheOptions shared_options(const fs::path& folder, const std::string& address) {
  CacheOptions options;
  options.folder = folder;
  options.remote = address;
  options.remote_timeout = kTimeout;
  return options;
}

void store_numbers(Cache& cache, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) cache.store(numbered_key(i), numbered_payload(i, kSize));
}

Answers load_numbers(Cache& cache, std::uint64_t count) {
  Answers answers;
  for (std::uint64_t i = 0; i < count; ++i) judge(answers, cache, i, kSize);
  return answers;
}

std::string remote_name(std::uint64_t number) {
  return "relievo:1:" + to_string(numbered_key(number));
}

TEST(CacheRemote, ServesASecondFolder) {
  const RedisServer server;
  const TemporaryFolder folder;
  {
    LoggedCache first(shared_options(folder / "first", server.address() + "/3"));
    store_numbers(*first, 300);
    EXPECT_THAT(first.said(), IsEmpty());
  }
  LoggedCache second(shared_options(folder / "second", server.address() + "/3"));
  EXPECT_EQ(load_numbers(*second, 300).right, 300);
  EXPECT_EQ(second->counts().remote_hits, 300u);
  EXPECT_EQ(second->counts().hits, 0u);
  EXPECT_EQ(load_numbers(*second, 301).right, 300);
  EXPECT_EQ(second->counts().hits, 300u);
  EXPECT_EQ(second->counts().misses, 1u);
  EXPECT_THAT(second.said(), IsEmpty());
  LoggedCache other_database(shared_options(folder / "third", server.address()));
  EXPECT_EQ(load_numbers(*other_database, 10).none, 10);
}

TEST(CacheRemote, ServesManyThreads) {
  const RedisServer server;
  const TemporaryFolder folder;
  LoggedCache first(shared_options(folder / "first", server.address()));
  LoggedCache second(shared_options(folder / "second", server.address()));
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint64_t i = 0; i < 200; ++i) first->store(numbered_key(i % 40), numbered_payload(i % 40, kSize));
      Answers answers;
      for (std::uint64_t i = 0; i < 200; ++i) judge(answers, *second, (i + t) % 40, kSize);
      wrong += answers.wrong;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(second->counts().remote_hits, 0u);
  EXPECT_THAT(second.said(), IsEmpty());
}

TEST(CacheRemote, DamagedEntryIsAMissAndIsReplaced) {
  const RedisServer server;
  const TemporaryFolder folder;
  LoggedCache first(shared_options(folder / "first", server.address()));
  store_numbers(*first, 2);
  first.close();
  ASSERT_TRUE(server.command({"SETRANGE", remote_name(0), "500", "damage"}).starts_with(":"));
  ASSERT_TRUE(server.command({"SET", remote_name(1), "short"}).starts_with("+OK"));
  LoggedCache second(shared_options(folder / "second", server.address()));
  EXPECT_EQ(load_numbers(*second, 2).none, 2);
  EXPECT_EQ(second->counts().broken, 2u);
  EXPECT_EQ(second.said().size(), 2u);
  EXPECT_TRUE(server.command({"EXISTS", remote_name(0), remote_name(1)}).starts_with(":0"));
  store_numbers(*second, 2);
  second.close();
  LoggedCache third(shared_options(folder / "third", server.address()));
  EXPECT_EQ(load_numbers(*third, 2).right, 2);
}

TEST(CacheRemote, ConnectionThatTheServerClosedIsMadeAnew) {
  const RedisServer server;
  const TemporaryFolder folder;
  LoggedCache cache(shared_options(folder / "first", server.address()));
  ASSERT_THAT(server.command({"CLIENT", "KILL", "TYPE", "normal", "SKIPME", "yes"}), HasSubstr(":1"));
  // More than the socket takes at once: what is sent after the first piece would raise SIGPIPE.
  cache->store(numbered_key(0), numbered_payload(0, 8 << 20));
  cache.close();
  EXPECT_TRUE(server.command({"EXISTS", remote_name(0)}).starts_with(":1"));
  EXPECT_THAT(cache.said(), IsEmpty());
}

TEST(CacheRemote, FullServerIsStillRead) {
  const RedisServer server;
  const TemporaryFolder folder;
  LoggedCache first(shared_options(folder / "first", server.address()));
  store_numbers(*first, 5);
  first.close();
  ASSERT_TRUE(server.command({"CONFIG", "SET", "maxmemory", "1"}).starts_with("+OK"));
  LoggedCache second(shared_options(folder / "second", server.address()));
  for (std::uint64_t i = 100; i < 110; ++i) second->store(numbered_key(i), numbered_payload(i, kSize));
  EXPECT_EQ(load_numbers(*second, 5).right, 5);
  EXPECT_EQ(second->counts().failed_stores, 0u);
  second.close();
  EXPECT_THAT(second.said(), ElementsAre(HasSubstr("only read from now on")));
}

/// The run goes on in the folder: all of it works, one sentence is said, and it waits at most once.
void expect_local_service(LoggedCache& cache, steady_clock::time_point start) {
  store_numbers(*cache, 20);
  EXPECT_EQ(load_numbers(*cache, 25).right, 20);
  EXPECT_EQ(cache->counts().misses, 5u);
  EXPECT_EQ(cache->counts().hits, 20u);
  cache.close();
  EXPECT_LT(steady_clock::now() - start, kTimeout + kSlack);
  EXPECT_THAT(cache.said(), ElementsAre(HasSubstr("is not used any more")));
}

TEST(CacheRemote, ServerThatIsNotThereIsSaidOnce) {
  const TemporaryFolder folder;
  const int port = LoopbackSocket().port();
  for (const std::string& address :
       {"redis://127.0.0.1:" + std::to_string(port), std::string("redis://host.invalid")}) {
    const auto start = steady_clock::now();
    LoggedCache cache(shared_options(folder / std::to_string(address.size()), address));
    expect_local_service(cache, start);
  }
}

TEST(CacheRemote, ServerThatNeverAnswersCostsOneTimeout) {
  const TemporaryFolder folder;
  const FakeServer server;
  const auto start = steady_clock::now();
  LoggedCache cache(shared_options(folder.path(), server.address()));
  EXPECT_GT(steady_clock::now() - start, kTimeout - milliseconds(20));  // it was asked
  expect_local_service(cache, start);
}

TEST(CacheRemote, ServerKilledInBetweenIsSaidOnce) {
  RedisServer server;
  const TemporaryFolder folder;
  LoggedCache cache(shared_options(folder.path(), server.address()));
  cache->store(numbered_key(0), numbered_payload(0, kSize));
  server.stop();
  expect_local_service(cache, steady_clock::now());
}

TEST(CacheRemote, ServerStoppedInBetweenCostsOneTimeout) {
  const RedisServer server;
  const TemporaryFolder folder;
  LoggedCache cache(shared_options(folder.path(), server.address()));
  server.signal(SIGSTOP);
  expect_local_service(cache, steady_clock::now());
}

TEST(CacheRemote, AnswerThatNeverEndsCostsOneTimeout) {
  const TemporaryFolder folder;
  const FakeServer server([](int fd, const std::atomic<bool>& ended) {
    std::string answer = "$100000\r\n";
    while (!ended && ::send(fd, answer.data(), answer.size(), MSG_NOSIGNAL) > 0) {
      answer = "x";
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  const auto start = steady_clock::now();
  LoggedCache cache(shared_options(folder.path(), server.address()));
  expect_local_service(cache, start);
}

TEST(CacheRemote, NonsenseIsSaidOnce) {
  for (const std::string& nonsense :
       {std::string("HTTP/1.1 400 Bad Request\r\n\r\n"), std::string("*2147483647\r\n"), std::string("$-7\r\n"),
        std::string("$99999999999999999999\r\n"), std::string("\0\0\0", 3), std::string("-NOAUTH no\r\n")}) {
    const TemporaryFolder folder;
    const FakeServer server([&](int fd, const std::atomic<bool>&) {
      char buffer[4096];
      (void)!::recv(fd, buffer, sizeof buffer, 0);
      (void)!::send(fd, nonsense.data(), nonsense.size(), MSG_NOSIGNAL);
    });
    const auto start = steady_clock::now();
    LoggedCache cache(shared_options(folder.path(), server.address()));
    expect_local_service(cache, start);
  }
}

// Every answer in time, but each takes long: what waits to be stored at the end must not keep the run for ever.
TEST(CacheRemote, SlowServerHoldsTheEndUpForTenTimeoutsAtMost) {
  const TemporaryFolder folder;
  const FakeServer server([](int fd, const std::atomic<bool>& ended) {
    char buffer[1 << 17];
    for (int commands = 0; !ended; ++commands) {
      if (::recv(fd, buffer, sizeof buffer, 0) <= 0) return;
      if (commands > 0) std::this_thread::sleep_for(milliseconds(40));
      (void)!::send(fd, "+OK\r\n", 5, MSG_NOSIGNAL);
    }
  });
  CacheOptions options = shared_options(folder.path(), server.address());
  options.remote_timeout = milliseconds(60);
  LoggedCache cache(options);
  for (std::uint64_t i = 0; i < 100; ++i) cache->store(numbered_key(i), numbered_payload(i, 100));
  const auto start = steady_clock::now();
  cache.close();
  EXPECT_LT(steady_clock::now() - start, 10 * options.remote_timeout + kSlack);
  EXPECT_THAT(cache.said(), ElementsAre(HasSubstr("redis://")));
}

}  // namespace
}  // namespace relievo::test
