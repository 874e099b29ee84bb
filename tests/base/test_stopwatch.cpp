#include "base/stopwatch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "base/context.h"

namespace delquad {
namespace {

constexpr double kPause = 0.03, kSlack = 0.02;

void pause() { std::this_thread::sleep_for(std::chrono::duration<double>(kPause)); }

TimeSpent time_of(const std::function<void()>& work) {
  const Stopwatch watch;
  work();
  return watch.time();
}

// Whoever sleeps counts as at work, so that the clock is known however busy the machine is: at least that of
// the pauses.
TEST(Stopwatches, OneThreadIsAlone) {
  const RunScope run({.threads = 1});
  const Stopwatch watch;
  const TimeSpent time = time_of([] { parallel_for(3, [](std::size_t) { pause(); }); });
  EXPECT_GE(time.work, 3 * kPause);
  EXPECT_NEAR(time.clock, time.work, kSlack);
  EXPECT_NEAR(time.alone, time.work, kSlack);
  EXPECT_LT(time.cpu, time.work);
  EXPECT_LE(time.work, watch.seconds());
}

TEST(Stopwatches, ThreadsShareTheClock) {
  const RunScope run({.threads = 2});
  const Stopwatch watch;
  const TimeSpent alone = time_of(pause);
  const TimeSpent together = time_of([] { parallel_for(2, [](std::size_t) { pause(); }); });
  const double all = watch.seconds();
  EXPECT_NEAR(alone.alone, alone.clock, 1e-3);
  EXPECT_GE(together.work, 2 * kPause);
  EXPECT_LE(together.clock, together.work);
  EXPECT_LE(together.alone, together.clock + 1e-3);
  EXPECT_LE(alone.clock + together.clock, all);
}

TEST(Stopwatches, StepsSideBySideAddUpToTheClock) {
  const RunScope run({.threads = 2});
  TimeSpent steps[3];
  const Stopwatch watch;
  parallel_for(
      3, [&](std::size_t i) { steps[i] = time_of([] { parallel_for(2, [](std::size_t) { pause(); }); }); });
  const double seconds = watch.seconds();
  const TimeSpent all = watch.time(), sum = steps[0] + steps[1] + steps[2];
  EXPECT_GE(sum.work, 6 * kPause);
  EXPECT_NEAR(sum.work, all.work, kSlack);
  EXPECT_NEAR(sum.clock, all.clock, kSlack);
  EXPECT_NEAR(all.clock, seconds, kSlack);
  EXPECT_LE(sum.alone, all.alone + 1e-3);
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
