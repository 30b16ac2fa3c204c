// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <gtest/gtest.h>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/parallel_sort.h"

namespace kiln::test_parallel {

TEST(Parallel, EveryTurnComesOnceAndIsSeenAfterwards) {
  for (const std::size_t grain : {1, 7, 1000}) {
    std::vector<int> turns(10000, 0);  // not atomic: the thread sanitizer looks whether the end of a loop is seen
    parallel_for(std::size_t{0}, turns.size(), grain, [&](std::size_t k) { turns[k] += static_cast<int>(k); });
    for (std::size_t k = 0; k < turns.size(); ++k) ASSERT_EQ(turns[k], static_cast<int>(k));
  }
}

TEST(Parallel, EmptyAndReversedRangesHaveNoTurns) {
  int turns = 0;
  parallel_for(3, 3, [&](int) { ++turns; });
  parallel_for(1, -1, [&](int) { ++turns; });
  parallel_ranges(5, 5, 1, [&](std::size_t, std::size_t) { ++turns; });
  EXPECT_EQ(turns, 0);
}

TEST(Parallel, RangesMakeUpTheWholeAndAreDividedOnlyAboveTheGrain) {
  std::mutex mutex;
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  parallel_ranges(10, 1010, 64, [&](std::size_t first, std::size_t last) {
    const std::lock_guard lock(mutex);
    ranges.emplace_back(first, last);
  });
  std::sort(ranges.begin(), ranges.end());
  std::size_t end = 10;
  for (const auto& [first, last] : ranges) {
    EXPECT_EQ(first, end);
    EXPECT_GE(last - first, 32u);
    end = last;
  }
  EXPECT_EQ(end, 1010u);
}

TEST(Parallel, ExceptionsOfTurnsReachTheCaller) {
  EXPECT_THROW(parallel_for(0, 1000,
                            [](int k) {
                              if (k == 500) throw std::runtime_error("turn 500");
                            }),
               std::runtime_error);
  EXPECT_THROW(parallel_invoke([] {}, [] { throw std::runtime_error("the other"); }), std::runtime_error);
}

TEST(Parallel, LoopsMayStandInsideLoops) {
  std::vector<std::vector<int>> table(20, std::vector<int>(300, 0));
  parallel_for(std::size_t{0}, table.size(), [&](std::size_t row) {
    parallel_for(std::size_t{0}, table[row].size(), 16, [&](std::size_t k) { table[row][k] = 1; });
    table[row][0] = static_cast<int>(std::count(table[row].begin(), table[row].end(), 1));
  });
  for (const std::vector<int>& row : table) EXPECT_EQ(row[0], 300);
}

TEST(Parallel, BothFunctionsAreCalled) {
  int one = 0, other = 0;
  parallel_invoke([&] { one = 1; }, [&] { other = 2; });
  EXPECT_EQ(one, 1);
  EXPECT_EQ(other, 2);
}

TEST(Parallel, ALimitOfOneThreadKeepsTheOrder) {
  const ThreadLimit limit(1);
  std::vector<int> turns;
  parallel_for(0, 1000, [&](int k) { turns.push_back(k); });
  ASSERT_EQ(turns.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(turns.begin(), turns.end()));
}

TEST(Parallel, SortsByLess) {
  std::vector<int> values(5000);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<int>(k * 7919 % 5000);
  parallel_sort(values.begin(), values.end());
  for (std::size_t k = 0; k < values.size(); ++k) ASSERT_EQ(values[k], static_cast<int>(k));
}

}  // namespace kiln::test_parallel
