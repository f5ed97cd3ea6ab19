/// The cache with entries of the size that a permutation's program has. A warm run loads about 3000 of them.
#include <benchmark/benchmark.h>

#include "support/caches.hpp"
#include "support/files.hpp"
#include "support/redis_server.hpp"

namespace relievo::test {
namespace {

constexpr std::size_t kSize = 80'000;
constexpr std::uint64_t kEntries = 1000;

struct Shared {
  TemporaryFolder folder;
  std::unique_ptr<RedisServer> server;
  std::unique_ptr<LoggedCache> cache;
  std::vector<std::string> payloads;
};
std::unique_ptr<Shared> shared;

void open_shared(std::uint64_t max_bytes) {
  shared = std::make_unique<Shared>();
  CacheOptions options;
  options.folder = shared->folder.path();
  options.max_bytes = max_bytes;
  shared->cache = std::make_unique<LoggedCache>(options);
  for (std::uint64_t i = 0; i < 16; ++i) shared->payloads.push_back(numbered_payload(i, kSize));
}

void open_new(const benchmark::State&) {
  open_shared(std::uint64_t{4} << 30);
}
void open_filled(const benchmark::State& state) {
  open_new(state);
  for (std::uint64_t i = 0; i < kEntries; ++i) (*shared->cache)->store(numbered_key(i), shared->payloads[i % 16]);
}
void open_small(const benchmark::State&) {
  open_shared(std::uint64_t{64} << 20);
}

/// Behind an empty folder: every load goes to Redis and fills the folder.
void open_remote(const benchmark::State&) {
  open_shared(std::uint64_t{4} << 30);
  shared->server = std::make_unique<RedisServer>();
  CacheOptions options;
  options.folder = shared->folder / "first";
  options.remote = shared->server->address();
  LoggedCache first(options);
  for (std::uint64_t i = 0; i < kEntries; ++i) first->store(numbered_key(i), shared->payloads[i % 16]);
  first.close();
  options.folder = shared->folder / "second";
  shared->cache = std::make_unique<LoggedCache>(options);
}
void close_shared(const benchmark::State&) {
  shared.reset();
}

std::uint64_t number_of(const benchmark::State& state, std::uint64_t i) {
  return i * static_cast<std::uint64_t>(state.threads()) + static_cast<std::uint64_t>(state.thread_index());
}

void report(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kSize));
}

void CacheLoad(benchmark::State& state) {
  std::uint64_t i = 0;
  for (auto _ : state) {
    const auto payload = (*shared->cache)->load(numbered_key(number_of(state, i++) % kEntries));
    if (!payload || payload->size() != kSize) return state.SkipWithError("an entry is lost");
  }
  report(state);
}

void CacheMiss(benchmark::State& state) {
  std::uint64_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize((*shared->cache)->load(numbered_key(1'000'000 + i++)));
  state.SetItemsProcessed(state.iterations());
}

void CacheStore(benchmark::State& state) {
  std::uint64_t i = 0;
  for (auto _ : state) {
    const std::uint64_t number = number_of(state, i++);
    (*shared->cache)->store(numbered_key(number), shared->payloads[number % 16]);
  }
  if ((*shared->cache)->counts().failed_stores > 0) state.SkipWithError("an entry is not kept");
  report(state);
}

BENCHMARK(CacheLoad)->Setup(open_filled)->Teardown(close_shared)->ThreadRange(1, 2)->UseRealTime();
BENCHMARK(CacheMiss)->Setup(open_filled)->Teardown(close_shared)->UseRealTime();
BENCHMARK(CacheStore)->Setup(open_new)->Teardown(close_shared)->ThreadRange(1, 2)->Iterations(3000)->UseRealTime();
BENCHMARK(CacheStore)
    ->Name("CacheStoreEvicting")
    ->Setup(open_small)
    ->Teardown(close_shared)
    ->Iterations(5000)
    ->UseRealTime();
BENCHMARK(CacheLoad)
    ->Name("CacheLoadFromRedis")
    ->Setup(open_remote)
    ->Teardown(close_shared)
    ->ThreadRange(1, 2)
    ->Iterations(kEntries / 2)
    ->UseRealTime();

}  // namespace
}  // namespace relievo::test
