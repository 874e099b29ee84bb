// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/console/progress.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/peer.h"
#include "experiments/sweep/process_tree.h"

// This header has the work on the cells of one variant. The bench uses it.

namespace delquad {

/// How many cells of a sweep are done, counted by every process that works on it. A bar on the last line of a
/// terminal shows them, with the time left for the sweep and for the experiments after it.
class SweepProgress {
 public:
  SweepProgress(std::size_t cells, PlaceInQueue place);
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
  std::string time_left(std::size_t done) const;

  struct Counts {
    std::atomic<std::size_t> done = 0, failed = 0, interrupted = 0;
  };
  Counts* counts_;  ///< memory that all processes share
  std::size_t cells_, found_ = 0;
  PlaceInQueue place_;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Prints a line on standard error, in one piece: several processes may speak at once.
void print_line(const std::string& text);

struct Cell {
  const Word* word;
  CellIdentity identity;
  std::filesystem::path folder;
  ReferenceCell reference = {};  ///< that a peer is calibrated to
  bool may_fail = false;
};

bool is_done(const Cell& cell);

/// A variant of a case with the cells that are to be made from it. Each process that works on it has its own.
struct VariantWork {
  Case c;
  std::vector<Cell> cells;
  SweepProgress* progress;
  bool allow_unsound;
  bool pictures;
  Prepared prepared;
  std::optional<Meshing> meshing;  ///< of a word

  /// Prepares the variant before the first stage.
  void prepare();
  /// Finishes a cell after the last stage: its files are measured and in place.
  void finish(const Cell& cell);
  /// Records a cell whose process did not get to its end.
  void fail(const Cell& cell, const ProcessFailure& why) const;
  /// Leaves a record of why there is no mesh, and what a peer read and printed; nothing where the cell was
  /// interrupted: it is to be made yet.
  void give_up(const Cell& cell, const std::string& status, const ProcessFailure& why) const;
};

}  // namespace delquad
