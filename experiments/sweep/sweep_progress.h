#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>

namespace delquad {

/// How many cells of a sweep are done, counted by every process that works on it, and a bar with the time
/// left on the last line of a terminal.
class SweepProgress {
 public:
  explicit SweepProgress(std::size_t cells);
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void found(std::size_t cells);  ///< done in an earlier run
  void done() { ++counts_->done; }
  void failed() {
    ++counts_->done;
    ++counts_->failed;
  }
  void interrupted() {
    failed();
    ++counts_->interrupted;
  }
  /// Cells that somebody else ended, and that have no record.
  std::size_t n_interrupted() const { return counts_->interrupted; }
  void draw();

 private:
  struct Counts {
    std::atomic<std::size_t> done = 0, failed = 0, interrupted = 0;
  };
  Counts* counts_;  ///< memory that all processes share
  std::size_t cells_, found_ = 0;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace delquad
