#include "base/stopwatch.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kPause = 0.03, kRounding = 1e-6;

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
  EXPECT_NEAR(time.clock, time.work, kRounding);
  EXPECT_NEAR(time.alone, time.work, kRounding);
  EXPECT_LT(time.cpu, time.work);
  EXPECT_LE(time.work, watch.seconds() + kRounding);
}

TEST(Stopwatches, ThreadsShareTheClock) {
  const RunScope run({.threads = 2});
  const Stopwatch watch;
  const TimeSpent alone = time_of(pause);
  const TimeSpent together = time_of([] { parallel_for(2, [](std::size_t) { pause(); }); });
  const double all = watch.seconds();
  EXPECT_NEAR(alone.alone, alone.clock, kRounding);
  EXPECT_GE(together.work, 2 * kPause);
  EXPECT_LE(together.clock, together.work + kRounding);
  EXPECT_LE(together.alone, together.clock + kRounding);
  EXPECT_LE(alone.clock + together.clock, all + kRounding);
}

TEST(Stopwatches, StepsSideBySideAddUpToTheClock) {
  const RunScope run({.threads = 2});
  TimeSpent steps[3];
  const Stopwatch watch;
  parallel_for(
      3, [&](std::size_t i) { steps[i] = time_of([] { parallel_for(2, [](std::size_t) { pause(); }); }); });
  const TimeSpent all = watch.time(), sum = steps[0] + steps[1] + steps[2];
  const double seconds = watch.seconds();
  EXPECT_GE(sum.work, 6 * kPause);
  EXPECT_LE(sum.work, all.work + kRounding);
  EXPECT_LE(sum.clock, all.clock + kRounding);
  EXPECT_LE(all.clock, seconds + kRounding);
  EXPECT_GE(all.clock, seconds / 2);
  EXPECT_LE(sum.alone, all.alone + kRounding);
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
