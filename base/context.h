#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "base/cancel.h"

// What belongs to one call of the library, and not to the process: how many threads it uses, whether it has
// been cancelled, when its time is up, and what it is at. It is found through the thread: a scope sets it for
// the thread that makes the scope, and parallel_for() for those that work for it.

namespace delquad {

class Activities;

/// How work is done, as opposed to what: nothing of it changes a result.
struct RunSettings {
  /// Of parallel_for(), the calling one included; 0: as in the scope around, without one as many as the
  /// machine has cores.
  int threads = 0;
  std::stop_token cancel = {};
  double seconds = 0;  ///< from the beginning of the scope; 0: no limit
  /// Told what is being done; null: those of the scope around, without one the scope's own. Must outlive the
  /// scope.
  Activities* activities = nullptr;
  /// Called by every check, on the thread that makes it. For tests.
  std::function<void()> on_check = {};
};

class Run;

/// From here to the end of the scope, this thread works by these settings. A scope in a scope is cancelled
/// with it, and ends with its time. Scopes on different threads have nothing to do with each other.
class RunScope {
 public:
  /// Throws std::invalid_argument when a number is below zero or not finite.
  explicit RunScope(RunSettings settings = {});
  ~RunScope();
  RunScope(const RunScope&) = delete;
  RunScope& operator=(const RunScope&) = delete;

 private:
  std::unique_ptr<Run> run_;
  int entry_before_ = -1;
  bool in_arena_before_ = false;
};

/// The run of this thread; null outside of scopes.
Run* current_run() noexcept;

/// For threads that others than parallel_for() start: this thread works for `run`, which may be null, from
/// here to the end of the scope.
class WorksFor {
 public:
  explicit WorksFor(Run* run) noexcept;
  ~WorksFor();
  WorksFor(const WorksFor&) = delete;
  WorksFor& operator=(const WorksFor&) = delete;

 private:
  Run* run_before_;
  int entry_before_;
  bool in_arena_before_;
};

/// What is told of what the run of this thread is at; null outside of scopes.
Activities* current_activities() noexcept;

}  // namespace delquad
