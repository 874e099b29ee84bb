// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/console/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>

#include "base/system.h"
#include "experiments/console/interrupt.h"

namespace delquad {

namespace {

std::atomic<Verbosity> chosen = Verbosity::kNormal;

}  // namespace

void set_verbosity(Verbosity v) { chosen = v; }
Verbosity verbosity() { return chosen; }

std::vector<std::string> lines_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> lines;
  if (verbosity() == Verbosity::kQuiet) return lines;
  if (verbosity() == Verbosity::kNormal) return summaries(warnings);
  for (const Warning& warning : warnings) lines.push_back(warning.text);
  return lines;
}

Progress::Progress(int steps)
    : shown_(steps > 0 && errors_have_a_terminal() && verbosity() != Verbosity::kQuiet), steps_(steps) {
  if (shown_) drawer_ = std::thread([this] { keep_drawing(); });
}

Progress::~Progress() {
  finish();
  if (!drawer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  over_.notify_one();
  drawer_.join();
}

void Progress::keep_drawing() {
  constexpr auto kPause = std::chrono::milliseconds(250);
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, kPause, [&] { return is_over_; })) draw();
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  clear();
  label_.clear();
}

void Progress::step(const std::string& label) {
  const std::lock_guard lock(mutex_);
  if (!label_.empty()) ++done_;
  label_ = label;
  draw();
}

void Progress::skip(int steps) {
  const std::lock_guard lock(mutex_);
  done_ += steps;
}

void Progress::message(const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear();
  fmt::print(stderr, "{}\n", text);
  draw();
}

void Progress::warn(const std::vector<Warning>& warnings) {
  for (const std::string& line : lines_of(warnings)) message("warning: " + line);
}

void Progress::draw() const {
  if (!shown_ || label_.empty()) return;
  constexpr int kWidth = 16;      // of the bar, in characters
  constexpr int kTextWidth = 60;  // so that the line fits 80 columns
  const int filled = kWidth * std::min(done_, steps_) / steps_;
  const std::string faces = program_activities().faces_text();
  fmt::print(stderr, "\r\x1b[2K[{}{}] {:.{}}", std::string(filled, '#'), std::string(kWidth - filled, '.'),
             label_ + (faces.empty() ? "" : ", " + faces), kTextWidth);
  std::fflush(stderr);
}

void Progress::clear() const {
  if (!shown_ || label_.empty()) return;
  fmt::print(stderr, "\r\x1b[2K");
  std::fflush(stderr);
}

}  // namespace delquad
