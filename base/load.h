#pragma once

#include <chrono>
#include <mutex>

namespace delquad {

/// How many threads of a run are at work, and for how long so many were. Safe to use from any thread.
class Load {
 public:
  struct Shares {
    double now = 0;    ///< seconds of the clock when they were read
    double clock = 0;  ///< seconds that a thread at work has had for its part so far: where N are, an Nth
    double alone = 0;  ///< seconds in which one thread was at work
  };
  void begin_thread() { change(1); }
  void end_thread() { change(-1); }
  Shares shares();

 private:
  using Clock = std::chrono::steady_clock;
  void change(int by);
  void advance();

  std::mutex mutex_;
  int threads_ = 1;  ///< the one that made the run
  Clock::time_point until_ = Clock::now();
  Shares shares_;
};

}  // namespace delquad
