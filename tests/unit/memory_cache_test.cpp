#include <gtest/gtest.h>

#include "relievo/cache.hpp"

namespace relievo {
namespace {

CacheKey key(int i) {
  return {0, static_cast<std::uint64_t>(i)};
}

TEST(MemoryCache, AnswersWithWhatWasStoredLast) {
  const auto cache = make_memory_cache(100);
  EXPECT_EQ(cache->load(key(1)), std::nullopt);
  cache->store(key(1), "one");
  cache->store(key(2), "");
  EXPECT_EQ(cache->load(key(1)), "one");
  EXPECT_EQ(cache->load(key(2)), "");
  cache->store(key(1), "another");
  EXPECT_EQ(cache->load(key(1)), "another");
  EXPECT_EQ(cache->counts().hits, 3U);
  EXPECT_EQ(cache->counts().misses, 1U);
  EXPECT_EQ(cache->counts().stores, 3U);
}

TEST(MemoryCache, DropsWhatWasUsedLongestAgo) {
  const auto cache = make_memory_cache(30);
  for (int i = 0; i < 3; ++i) cache->store(key(i), std::string(10, 'x'));
  EXPECT_TRUE(cache->load(key(0)));
  cache->store(key(3), std::string(20, 'y'));
  EXPECT_TRUE(cache->load(key(0)));
  EXPECT_FALSE(cache->load(key(1)));
  EXPECT_FALSE(cache->load(key(2)));
  EXPECT_TRUE(cache->load(key(3)));
  EXPECT_EQ(cache->counts().evictions, 2U);
}

TEST(MemoryCache, DoesNotKeepWhatIsTooLarge) {
  const auto cache = make_memory_cache(30);
  cache->store(key(1), std::string(10, 'x'));
  cache->store(key(2), std::string(31, 'x'));
  EXPECT_TRUE(cache->load(key(1)));
  EXPECT_FALSE(cache->load(key(2)));
}

}  // namespace
}  // namespace relievo
