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

/// How much the program tells besides its results: errors only, or warnings of a kind in one line each, or
/// all of them.
enum class Verbosity { kQuiet, kNormal, kAll };
void set_verbosity(Verbosity verbosity);
Verbosity verbosity();

/// Returns the warnings as lines to print, as many as verbosity() says.
std::vector<std::string> lines_of(const std::vector<Warning>& warnings);

/// Where an experiment stands among those that one command runs.
struct PlaceInQueue {
  std::string name = {};
  std::size_t index = 0, count = 1;         ///< index < count
  std::optional<double> seconds = {};       ///< that it may take; nothing: not known
  std::optional<double> seconds_after = 0;  ///< that those after it may take
};

/// A bar on the last line of a terminal, with the name of the work and its faces. It is silent without a
/// terminal, and when quiet.
class Progress {
 public:
  /// `steps`: how many times step() will be called; 0: no bar.
  explicit Progress(int steps = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the step that begins now.
  void step(const std::string& label);
  /// Steps that will not be taken.
  void skip(int steps);
  /// Prints a line to stderr, above the bar.
  void message(const std::string& text);
  /// Does the same for each line of the warnings.
  void warn(const std::vector<Warning>& warnings);
  /// Takes the bar away.
  void finish();

 private:
  void draw() const;
  void clear() const;
  /// Draws now and then, as faces come and go.
  void keep_drawing();

  bool shown_;
  int steps_, done_ = 0;
  std::string label_;
  std::mutex mutex_;  ///< of what is drawn
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread drawer_;
};

}  // namespace delquad
