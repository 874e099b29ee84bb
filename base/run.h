#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "base/activity.h"
#include "base/context.h"

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

/// The state of a run, for context.cpp, parallel.cpp and activity.cpp alone.
class Run {
 public:
  explicit Run(RunSettings settings, Run* around);

  enum class State { kGoing, kCancelled, kTimeIsUp };
  /// Of this run and those around it.
  State state() const noexcept;
  /// Its threads; made at the first use.
  tbb::task_arena& arena();
  /// Lets go of the arenas of this run and those around it; the next use makes them anew.
  void end_arenas();

  RunSettings settings;
  Run* around;
  double end;  ///< of the steady clock, in seconds; infinite: none
  std::optional<Activities> own_activities;
  Activities* activities;
  Load& load() noexcept { return around != nullptr ? around->load() : load_; }

 private:
  Load load_;
  std::optional<tbb::global_control> more_than_cores_;
  std::optional<tbb::task_arena> arena_;
};

/// What this thread does, and for whom.
struct ThreadState {
  Run* run = nullptr;
  int entry = -1;         ///< of the run's activities: its face; -1: none
  bool in_arena = false;  ///< the run's
};
ThreadState& this_thread() noexcept;

int core_count();

}  // namespace delquad
