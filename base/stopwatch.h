#pragma once

#include <chrono>

#include "base/parallel.h"

namespace delquad {

/// Time since it was made, by this thread.
class Stopwatch {
 public:
  /// Wall-clock.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// The same, with the times of all threads added up while parallel_for() ran: what one thread would have
  /// needed.
  double work_seconds() const { return seconds() + parallel_surplus() - surplus_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double surplus_ = parallel_surplus();
};

}  // namespace delquad
