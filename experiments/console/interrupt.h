// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/activity.h"

// This header handles signals and the time limit. The program and the bench use it.

namespace delquad {

/// Exit codes after Ctrl-C (SIGINT) and after SIGTERM: 128 plus the number of the signal, as in shells.
inline constexpr int kInterrupted = 130, kTerminated = 143;
/// Exit code after the time limit.
inline constexpr int kTimeIsUp = 1;

/// Lets SIGINT and SIGTERM end the program at once with kInterrupted and kTerminated, or as soon as no
/// Uninterrupted lives. Files that are being written are removed.
void exit_on_interrupt();

/// Delays signals while it lives, for files that belong together.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

/// Adds up the seconds of stages, each until the next one begins.
class StageTimes {
 public:
  /// `at` has seconds on any clock, ascending.
  void begin(const std::string& stage, double at);
  /// Returns "; boundary took longest: 4.2 s"; empty if that is the current stage.
  std::string longest(double at);

 private:
  std::map<std::string, double> seconds_;
  std::string stage_;
  double since_ = 0;
};

/// Ends the program with kTimeIsUp after its time, whatever threads are doing. One message tells the activity
/// (see activity.h) and the stage that took longest. Files that are being written are removed. Once the first
/// file has its place, the others follow instead, which takes no time.
class TimeLimit {
 public:
  /// `seconds` must be above 0.
  explicit TimeLimit(double seconds);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  struct Watch;
  std::unique_ptr<Watch> watch_;
};

/// Returns the current activities of this program, for its bar, its time limit and signal handlers. The run
/// of main() reports them, and runs inside of it.
Activities& program_activities();

}  // namespace delquad
