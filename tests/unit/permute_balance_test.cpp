/// Dividing closures: the same everywhere, and even.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "permute/shards.hpp"

namespace relievo {
namespace {

std::vector<double> loads(const std::vector<double>& seconds, const std::vector<unsigned>& assigned, unsigned shards) {
  std::vector<double> sums(shards, 0);
  for (std::size_t i = 0; i < seconds.size(); ++i) sums[assigned[i]] += seconds[i];
  return sums;
}

double spread(const std::vector<double>& sums) {
  return *std::max_element(sums.begin(), sums.end()) - *std::min_element(sums.begin(), sums.end());
}

TEST(AssignShards, DiffersByNoMoreThanTheLargest) {
  std::mt19937 random(3);
  std::exponential_distribution<double> seconds_of(2);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> seconds(1 + random() % 300);
    for (double& one : seconds) one = seconds_of(random);
    const double largest = *std::max_element(seconds.begin(), seconds.end());
    const unsigned shards = 1 + random() % 12;
    EXPECT_LE(spread(loads(seconds, assign_shards(seconds, shards), shards)), largest * (1 + 1e-9));
    if (seconds.size() < 200 || shards < 3) continue;
    std::vector<unsigned> in_pieces(seconds.size());  // what would not do: pieces of equal number
    for (std::size_t i = 0; i < in_pieces.size(); ++i)
      in_pieces[i] = static_cast<unsigned>(i * shards / in_pieces.size());
    EXPECT_LT(spread(loads(seconds, assign_shards(seconds, shards), shards)),
              spread(loads(seconds, in_pieces, shards)));
  }
}

TEST(AssignShards, IsTheSameEveryTimeAndUsesEveryShard) {
  const std::vector<double> equal(20, 0.5);
  const std::vector<unsigned> assigned = assign_shards(equal, 4);
  EXPECT_EQ(assigned, assign_shards(equal, 4));
  for (unsigned shard = 0; shard < 4; ++shard) EXPECT_EQ(std::count(assigned.begin(), assigned.end(), shard), 5);
  EXPECT_TRUE(assign_shards({}, 3).empty());
  EXPECT_EQ(assign_shards({1.0}, 1), std::vector<unsigned>{0});
}

}  // namespace
}  // namespace relievo
