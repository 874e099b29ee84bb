#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>
#include <optional>

#include "base/activity.h"
#include "base/context.h"

namespace delquad {

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

 private:
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
