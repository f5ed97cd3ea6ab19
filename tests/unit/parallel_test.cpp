#include "compile/parallel.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace relievo {
namespace {

TEST(Crew, RunsEveryTaskOnceInLoopAfterLoop) {
  Crew crew(4);
  for (std::size_t count = 0; count < 200; ++count) {
    std::vector<std::atomic<int>> calls(count);
    crew.run(count, [&](std::size_t i) { ++calls[i]; });
    for (const std::atomic<int>& c : calls) ASSERT_EQ(c, 1) << count;
  }
}

TEST(Crew, HasReturnedWhenItsTasksHave) {
  Crew crew(4);
  for (int loop = 0; loop < 2000; ++loop) {
    int sum[3] = {};  // gone after each turn: a late task would be seen by the sanitizers
    crew.run(3, [&](std::size_t i) { sum[i] = loop; });
    ASSERT_EQ(sum[0] + sum[1] + sum[2], 3 * loop);
  }
}

TEST(Crew, ThrowsWhatATaskThrowsAndGoesOn) {
  Crew crew(3);
  std::atomic<int> calls = 0;
  const auto fails_once = [&](std::size_t i) {
    ++calls;
    if (i == 5) throw std::runtime_error("task 5");
  };
  EXPECT_THROW(crew.run(10, fails_once), std::runtime_error);
  calls = 0;
  crew.run(5, fails_once);
  EXPECT_EQ(calls, 5);
}

TEST(Crew, OfOneStaysOnItsThread) {
  Crew crew(1);
  std::set<std::thread::id> threads;
  crew.run(20, [&](std::size_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

TEST(Crew, SharesTasksAmongItsThreads) {
  Crew crew(2);
  std::atomic<int> present = 0;
  crew.run(2, [&](std::size_t) {  // ends only when both are there
    ++present;
    while (present < 2) std::this_thread::yield();
  });
  EXPECT_EQ(present, 2);
}

TEST(LargestFirst, KeepsTheOrderOfEqualSizes) {
  const std::size_t sizes[] = {3, 9, 3, 0, 9};
  EXPECT_EQ(largest_first(5, [&](std::size_t i) { return sizes[i]; }), (std::vector<std::size_t>{1, 4, 0, 2, 3}));
}

}  // namespace
}  // namespace relievo
