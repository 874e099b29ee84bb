// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

class Parallel : public testing::TestWithParam<int> {
 protected:
  RunScope run_{{.threads = GetParam()}};
};

TEST_P(Parallel, EachIndexIsVisitedOnce) {
  for (const std::size_t n : {0u, 1u, 3u, 1000u}) {
    std::vector<int> visits(n, 0);
    parallel_for(
        n, [&](std::size_t i) { ++visits[i]; }, [](std::size_t i) { return double(i % 7); });
    EXPECT_EQ(visits, std::vector<int>(n, 1));
  }
}

TEST_P(Parallel, RangesMakeUpAllAndAreTheSameForEveryNumberOfThreads) {
  for (const std::size_t n : {0u, 1u, 1024u, 1025u, 5000u}) {
    std::vector<std::size_t> length(n, 0), expected(n, 1024);
    parallel_ranges(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) length[i] += end - begin;
    });
    for (std::size_t i = n - n % 1024; i < n; ++i) expected[i] = n % 1024;
    EXPECT_EQ(length, expected);
  }
}

TEST_P(Parallel, CallsMayNest) {
  std::vector<std::vector<int>> visits(20, std::vector<int>(50, 0));
  parallel_for(20, [&](std::size_t i) { parallel_for(50, [&, i](std::size_t j) { ++visits[i][j]; }); });
  EXPECT_EQ(visits, std::vector<std::vector<int>>(20, std::vector<int>(50, 1)));
}

TEST_P(Parallel, TheFirstErrorInOrderIsThrownAndTheRestIsDone) {
  std::vector<int> visits(100, 0);
  std::string message;
  try {
    parallel_for(
        100,
        [&](std::size_t i) {
          ++visits[i];
          if (i % 30 == 17) throw std::runtime_error(std::to_string(i));
        },
        [](std::size_t i) { return double(i); });
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  EXPECT_EQ(message, "17");
  EXPECT_EQ(visits, std::vector<int>(100, 1));
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 4));

TEST(ParallelOrder, CostlyOnesBeginFirst) {
  const RunScope run({.threads = 1});
  std::vector<std::size_t> order;
  const double cost[] = {1, 5, 3, 5};
  parallel_for(
      4, [&](std::size_t i) { order.push_back(i); }, [&](std::size_t i) { return cost[i]; });
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 3, 2, 0}));
}

}  // namespace
}  // namespace delquad
