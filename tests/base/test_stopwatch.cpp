// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stopwatch.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kPause = 0.03;

void pause() { std::this_thread::sleep_for(std::chrono::duration<double>(kPause)); }

TimeSpent time_of(const std::function<void()>& work) {
  const Stopwatch watch;
  work();
  return watch.time();
}

TEST(Stopwatches, SecondsAreThoseOfTheClock) {
  const RunScope run({.threads = 2});
  const TimeSpent time = time_of([] {
    pause();
    parallel_for(2, [](std::size_t) { pause(); });
  });
  EXPECT_GE(time.seconds, 2 * kPause);
  EXPECT_LT(time.cpu, time.seconds);
}

TEST(Stopwatches, ProcessorTimeIsThatOfAllThreads) {
  const RunScope run({.threads = 2});
  constexpr double kBusy = 0.02;
  const TimeSpent time = time_of([] {
    parallel_for(4, [](std::size_t) {
      const Stopwatch watch;
      while (watch.time().cpu < kBusy) continue;
    });
  });
  EXPECT_GE(time.cpu, 4 * kBusy);
}

}  // namespace
}  // namespace delquad
