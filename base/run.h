// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

#include "base/activity.h"
#include "base/context.h"

// This header has the state of a run. Base uses it.

namespace delquad {

/// State of a run, only for context.cpp, parallel.cpp and activity.cpp.
class Run {
 public:
  /// `around`: the outer run, which must outlive this one; null: none. Throws as RunScope.
  explicit Run(RunSettings settings, Run* around);

  enum class State { kGoing, kCancelled, kTimeIsUp };
  /// Returns the state of this run and outer ones.
  State state() const noexcept;
  /// Returns its threads, made at the first use.
  tbb::task_arena& arena();
  /// Releases the arenas of this run and outer ones; the next use makes new ones.
  void end_arenas();

  RunSettings settings;
  Run* around;
  double end;  ///< in seconds of the steady clock; infinite: none
  std::optional<Activities> own_activities;
  Activities* activities;

 private:
  std::optional<tbb::global_control> more_than_cores_;
  std::optional<tbb::task_arena> arena_;
};

/// Work of a thread, and its run.
struct ThreadState {
  Run* run = nullptr;
  int entry = -1;         ///< index of its face in the run's activities; -1: none
  bool in_arena = false;  ///< of the run
};
ThreadState& this_thread() noexcept;

int core_count();

}  // namespace delquad
