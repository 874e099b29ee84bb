// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include "base/activity.h"
#include "base/parallel.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

std::string message_of_check() {
  try {
    check_cancelled();
  } catch (const Cancelled& error) {
    return error.what();
  }
  return "";
}

TEST(Context, OutsideOfRunsNothingIsCancelled) {
  EXPECT_EQ(current_run(), nullptr);
  EXPECT_FALSE(is_cancelled());
  EXPECT_NO_THROW(check_cancelled());
}

TEST(Context, CancelledSaysAtWhat) {
  std::stop_source stop;
  const RunScope run({.cancel = stop.get_token()});
  const StageScope stage("matching");
  const FaceScope face(12);
  EXPECT_EQ(message_of_check(), "");
  stop.request_stop();
  EXPECT_TRUE(is_cancelled());
  EXPECT_TRUE(message_of_check().starts_with("cancelled: matching of face 12 (")) << message_of_check();
}

TEST(Context, TimeIsUpSaysTheLimitAndAtWhat) {
  const RunScope run({.seconds = 0.01});
  const StageScope stage("reading");
  while (!is_cancelled()) std::this_thread::yield();
  EXPECT_THROW(check_cancelled(), TimeIsUp);
  EXPECT_TRUE(message_of_check().starts_with("stopped after 0.01 s: reading (")) << message_of_check();
}

TEST(Context, AScopeInAScopeEndsWithIt) {
  std::stop_source stop;
  const RunScope outer({.threads = 3, .cancel = stop.get_token(), .seconds = 1e6});
  const RunScope inner({.seconds = 1e7});
  EXPECT_EQ(thread_count(), 3);
  EXPECT_FALSE(is_cancelled());
  stop.request_stop();
  EXPECT_THROW(check_cancelled(), Cancelled);
}

TEST(Context, AnInnerOneEndsAlone) {
  std::stop_source stop;
  const RunScope outer;
  {
    const RunScope inner({.cancel = stop.get_token()});
    stop.request_stop();
    EXPECT_TRUE(is_cancelled());
  }
  EXPECT_FALSE(is_cancelled());
}

TEST(Context, RefusesWhatIsNoNumberOfThreadsOrSeconds) {
  EXPECT_THROW(RunScope({.threads = -1}), std::invalid_argument);
  EXPECT_THROW(RunScope({.seconds = -1}), std::invalid_argument);
  EXPECT_THROW(RunScope({.seconds = std::numeric_limits<double>::infinity()}), std::invalid_argument);
  EXPECT_EQ(current_run(), nullptr);
}

class ContextOfThreads : public testing::TestWithParam<int> {};

TEST_P(ContextOfThreads, IsCarriedToThem) {
  std::stop_source stop;
  std::atomic<int> checks = 0;
  const RunScope scope({.threads = GetParam(), .cancel = stop.get_token(), .on_check = [&] { ++checks; }});
  const auto* const run = current_run();
  std::atomic<int> strangers = 0;
  parallel_for(20, [&](std::size_t) {
    parallel_for(20, [&](std::size_t) { strangers += current_run() != run; });
    strangers += current_run() != run;
  });
  EXPECT_EQ(strangers, 0);
  EXPECT_EQ(checks, 20 + 20 * 20);
  EXPECT_EQ(current_run(), run);
}

TEST_P(ContextOfThreads, WhatHasNotBegunIsLeftOnceCancelled) {
  std::stop_source stop;
  const RunScope scope({.threads = GetParam(), .cancel = stop.get_token()});
  std::atomic<int> begun = 0;
  EXPECT_THROW(parallel_for(1000,
                            [&](std::size_t) {
                              ++begun;
                              stop.request_stop();
                            }),
               Cancelled);
  EXPECT_LE(begun, GetParam());
}

TEST_P(ContextOfThreads, NoMoreThanAreAllowedWorkAtATime) {
  const RunScope scope({.threads = GetParam()});
  std::atomic<int> now = 0, most = 0;
  const auto work = [&](std::size_t) {
    const int here = ++now;
    for (int seen = most; here > seen && !most.compare_exchange_weak(seen, here);) {
    }
    std::this_thread::yield();
    --now;
  };
  parallel_for(50, [&](std::size_t) { parallel_for(50, work); });
  EXPECT_LE(most, GetParam());
}
INSTANTIATE_TEST_SUITE_P(Threads, ContextOfThreads, testing::Values(1, 2, 4));

/// Each by its own number, whatever the other one does.
TEST(Context, TwoRunsAtOnceHaveThreadsOfTheirOwn) {
  const auto work = [](int threads, int& most_seen) {
    const RunScope scope({.threads = threads});
    std::atomic<int> wrong = 0, now = 0, most = 0;
    for (int round = 0; round < 50; ++round)
      parallel_for(64, [&](std::size_t) {
        wrong += thread_count() != threads;
        const int here = ++now;
        for (int seen = most; here > seen && !most.compare_exchange_weak(seen, here);) {
        }
        std::this_thread::yield();
        --now;
      });
    EXPECT_EQ(wrong, 0);
    most_seen = most;
  };
  int most[3] = {};
  std::thread one(work, 1, std::ref(most[0])), three(work, 3, std::ref(most[1])),
      two(work, 2, std::ref(most[2]));
  one.join();
  three.join();
  two.join();
  EXPECT_EQ(most[0], 1);
  EXPECT_LE(most[1], 3);
  EXPECT_LE(most[2], 2);
}

/// One of them is cancelled, the other is not.
TEST(Context, CancellingOneRunLeavesTheOther) {
  std::stop_source stop;
  std::atomic<bool> is_over = false;
  std::thread cancelled([&] {
    const RunScope scope({.threads = 2, .cancel = stop.get_token()});
    EXPECT_THROW(for (;;) parallel_for(8, [](std::size_t) { check_cancelled(); }), Cancelled);
    is_over = true;
  });
  const RunScope scope({.threads = 2});
  stop.request_stop();
  while (!is_over) EXPECT_NO_THROW(parallel_for(8, [](std::size_t) { check_cancelled(); }));
  cancelled.join();
}

}  // namespace
}  // namespace delquad
