#include "pipeline/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace delquad {

Progress::Progress(int steps) : shown_(steps > 0 && isatty(STDERR_FILENO)), steps_(steps) {}
Progress::~Progress() { finish(); }

void Progress::finish() {
  clear();
  label_.clear();
}

void Progress::step(const std::string& label) {
  if (!label_.empty()) ++done_;
  label_ = label;
  draw();
}

void Progress::skip(int steps) { done_ += steps; }

void Progress::message(const std::string& text) {
  clear();
  fmt::print(stderr, "{}\n", text);
  draw();
}

void Progress::draw() const {
  if (!shown_ || label_.empty()) return;
  constexpr int kWidth = 24;       // of the bar, in characters
  constexpr int kLabelWidth = 48;  // so that the line fits 80 columns
  const int filled = kWidth * std::min(done_, steps_) / steps_;
  fmt::print(stderr, "\r\x1b[2K[{}{}] {:.{}}", std::string(filled, '#'), std::string(kWidth - filled, '.'),
             label_, kLabelWidth);
  std::fflush(stderr);
}

void Progress::clear() const {
  if (!shown_ || label_.empty()) return;
  fmt::print(stderr, "\r\x1b[2K");
  std::fflush(stderr);
}

}  // namespace delquad
