// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "base/cancel.h"

// This header has settings of one call of the library: threads, cancellation, time limit and activities. All
// modules find them through their thread. A scope sets them for its thread, and parallel_for() for its
// workers.

namespace delquad {

class Activities;

/// Settings of work that never change a result.
struct RunSettings {
  /// Threads of parallel_for(), with the calling one. 0: as in the outer scope, or the number of cores.
  int threads = 0;
  std::stop_token cancel = {};
  double seconds = 0;  ///< from the start of the scope; 0: no limit
  /// Receives the activities; null: the outer scope's, or own ones. Must outlive the scope.
  Activities* activities = nullptr;
  /// Called by every check on its thread, for tests.
  std::function<void()> on_check = {};
};

class Run;

/// Scope in which this thread works by these settings; scopes of a thread end in the reverse order. An inner
/// scope is cancelled with the outer one, and shares its time limit. Scopes on different threads are
/// independent.
class RunScope {
 public:
  /// Throws std::invalid_argument if a number is negative or not finite.
  explicit RunScope(RunSettings settings = {});
  ~RunScope();
  RunScope(const RunScope&) = delete;
  RunScope& operator=(const RunScope&) = delete;

 private:
  std::unique_ptr<Run> run_;
  int entry_before_ = -1;
  bool in_arena_before_ = false;
};

/// Returns the run of this thread; null outside of scopes.
Run* current_run() noexcept;

/// Scope in which a thread not started by parallel_for() works for `run`, which may be null.
class WorkerScope {
 public:
  explicit WorkerScope(Run* run) noexcept;
  ~WorkerScope();
  WorkerScope(const WorkerScope&) = delete;
  WorkerScope& operator=(const WorkerScope&) = delete;

 private:
  Run* run_before_;
  int entry_before_;
  bool in_arena_before_;
};

/// Returns the activities of this thread's run; null outside of scopes.
Activities* current_activities() noexcept;

}  // namespace delquad
