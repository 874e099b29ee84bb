// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "delquad/error.h"

// This header runs jobs in forked processes. The bench uses it.

namespace delquad {

/// A process that did not finish.
struct ProcessFailure {
  /// "bad input", "unsound", "peer", "internal error", "timeout", "memory" or "crash". "not applicable": a
  /// peer cannot get the case, which is no failure. "interrupted": somebody else ended it, such as a
  /// scheduler.
  std::string kind;
  std::string reason;  ///< for people
};

/// Work cannot continue, since one of its jobs failed; it has the same reason.
class JobFailed : public Error {
 public:
  explicit JobFailed(const ProcessFailure& why) : Error(why.reason), kind_(why.kind) {}
  const std::string& kind() const { return kind_; }

 private:
  std::string kind_;
};

/// Work in a separate process, and its consequences.
struct Job {
  std::function<void()> work;
  /// Jobs that start from the state after work(). Each is a process forked from this one, so that jobs share
  /// data but fail alone.
  std::function<std::vector<Job>()> next = {};
  /// Called in the parent process if this one did not finish.
  std::function<void(const ProcessFailure&)> failed;
};

struct ProcessLimits {
  int jobs = 1;         ///< processes at the same time, at least 1
  double seconds = 0;   ///< from the first work() of a chain of jobs to the end of its last one; 0: no limit
  long long bytes = 0;  ///< of memory for each process; 0: no limit
};

/// Runs the jobs of `next_job` until it returns none, and all that follow from them. If this process ends,
/// its children end, too. `tick` is called regularly.
void run_jobs(const std::function<std::optional<Job>()>& next_job, const ProcessLimits& limits,
              const std::function<void()>& tick = {});

}  // namespace delquad
