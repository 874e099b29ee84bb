#pragma once

#include <memory>

#include "base/activity.h"

namespace delquad {

/// Exit codes after Ctrl-C (SIGINT) and after SIGTERM: 128 and the signal's number, as shells have it.
inline constexpr int kInterrupted = 130, kTerminated = 143;
/// Exit code when time is up.
inline constexpr int kTimeIsUp = 1;

/// From now on SIGINT and SIGTERM end the program at once with kInterrupted and kTerminated, unless an
/// Uninterrupted lives: then as soon as the last of them dies. Files that are being written are removed.
void exit_on_interrupt();

/// While files are written that belong together.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

/// Ends the program with kTimeIsUp when it lives for so long, whatever its threads are at then: one message
/// tells what (see activity.h), and files that are being written are removed. Once the first file stands at
/// its place, what is left is done instead: it takes no time.
class TimeLimit {
 public:
  /// Seconds, > 0.
  explicit TimeLimit(double seconds);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  struct Watch;
  std::unique_ptr<Watch> watch_;
};

/// What this program is at, for its bar, its time limit and signal handlers: the run that main() makes tells
/// it, and those inside of that.
Activities& program_activities();

}  // namespace delquad
