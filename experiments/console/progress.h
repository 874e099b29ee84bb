// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/warning.h"

// This header prints progress and warnings. The program and the bench use it.

namespace delquad {

/// Amount of messages besides results: errors only, warnings of a kind in one line each, or all warnings.
enum class Verbosity { kQuiet, kNormal, kAll };
void set_verbosity(Verbosity verbosity);
Verbosity verbosity();

/// Returns the lines to print for warnings at the current verbosity.
std::vector<std::string> lines_of(const std::vector<Warning>& warnings);

/// Place of an experiment among the experiments of a command.
struct PlaceInQueue {
  std::string name = {};
  std::size_t index = 0, count = 1;         ///< index < count
  std::optional<double> seconds = {};       ///< expected time; nothing: not known
  std::optional<double> seconds_after = 0;  ///< expected time of later experiments
};

/// A progress bar on the last line of a terminal, with the name of the work and its faces. It is silent
/// without a terminal, and if quiet.
class Progress {
 public:
  /// `steps` is the number of calls of step(); 0: no bar.
  explicit Progress(int steps = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the next step.
  void step(const std::string& label);
  /// Skips steps.
  void skip(int steps);
  /// Prints a line to stderr, above the bar.
  void message(const std::string& text);
  /// Prints the lines of warnings in the same way.
  void warn(const std::vector<Warning>& warnings);
  /// Removes the bar.
  void finish();

 private:
  void draw() const;
  void clear() const;
  /// Redraws regularly, as faces come and go.
  void keep_drawing();

  bool shown_;
  int steps_, done_ = 0;
  std::string label_;
  std::mutex mutex_;  ///< guards the drawing
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread drawer_;
};

}  // namespace delquad
