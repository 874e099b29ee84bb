#pragma once

#include <chrono>

#include "base/parallel.h"

namespace delquad {

/// Time since it was made, by this thread.
class Stopwatch {
 public:
  /// Wall-clock.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// With that of the threads that worked for this one while parallel_for() ran.
  TimeSpent time() const { return time_spent() - spent_; }
  /// What one thread would have needed.
  double work_seconds() const { return time().work; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  TimeSpent spent_ = time_spent();
};

}  // namespace delquad
