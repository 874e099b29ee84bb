// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "delquad/error.h"

// This header runs jobs in forked processes. The bench uses it.

namespace delquad {

/// A process that did not get to its end.
struct ProcessFailure {
  /// "bad input", "unsound", "peer", "internal error", "timeout", "memory" or "crash". "not applicable": a
  /// peer cannot be told the case, which is no failure. "interrupted": somebody else ended it, as a scheduler
  /// does, which says nothing of the work
  std::string kind;
  std::string reason;  ///< for people
};

/// Thrown by work that cannot go on, since a job of its own failed: it has failed for that reason.
class JobFailed : public Error {
 public:
  explicit JobFailed(const ProcessFailure& why) : Error(why.reason), kind_(why.kind) {}
  const std::string& kind() const { return kind_; }

 private:
  std::string kind_;
};

/// Something that runs in a process of its own, and what follows from it.
struct Job {
  std::function<void()> work;
  /// Jobs that start from the state that work() has left. Each is a process of its own, forked from this one,
  /// so that jobs share common data and die alone.
  std::function<std::vector<Job>()> next = {};
  /// Called in the process that started this one, when it did not get to its end.
  std::function<void(const ProcessFailure&)> failed;
};

struct ProcessLimits {
  int jobs = 1;         ///< processes that work at the same time, at least 1
  double seconds = 0;   ///< from the first work() of a chain of jobs to the end of its last; 0: no limit
  long long bytes = 0;  ///< of memory that a process may hold; 0: no limit
};

/// Runs the jobs that `next_job` hands out until it has none left, and all that follow from them. When this
/// process dies, those that it started die, too. `tick` is called now and then.
void run_jobs(const std::function<std::optional<Job>()>& next_job, const ProcessLimits& limits,
              const std::function<void()>& tick = {});

}  // namespace delquad
