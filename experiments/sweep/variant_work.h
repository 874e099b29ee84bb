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

/// Numbers of finished cells of a sweep, counted by all of its processes. A bar on the last line of a
/// terminal shows them, with the time left for the sweep and for later experiments.
class SweepProgress {
 public:
  SweepProgress(std::size_t cells, PlaceInQueue place);
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void found(std::size_t cells);  ///< adds cells of an earlier run
  void done() { ++counts_->done; }
  void failed() {
    ++counts_->done;
    ++counts_->failed;
  }
  void interrupted() {
    failed();
    ++counts_->interrupted;
  }
  /// Returns the number of cells that somebody else ended, which have no record.
  std::size_t n_interrupted() const { return counts_->interrupted; }
  void draw();

 private:
  std::string time_left(std::size_t done) const;

  struct Counts {
    std::atomic<std::size_t> done = 0, failed = 0, interrupted = 0;
  };
  Counts* counts_;  ///< in memory that all processes share
  std::size_t cells_, found_ = 0;
  PlaceInQueue place_;
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Prints a line on standard error in one piece, since several processes may print.
void print_line(const std::string& text);

struct Cell {
  const Pipeline* pipeline;
  CellIdentity identity;
  std::filesystem::path folder;
  ReferenceCell reference = {};  ///< cell to which a peer is calibrated
  bool may_fail = false;
};

bool is_done(const Cell& cell);

/// A variant of a case with its cells to run. Each process has its own.
struct VariantWork {
  Case c;
  std::vector<Cell> cells;
  SweepProgress* progress;
  bool allow_unsound;
  bool pictures;
  Prepared prepared;
  std::optional<Meshing> meshing;  ///< of a pipeline

  /// Prepares the variant before the first stage.
  void prepare();
  /// Finishes a cell after the last stage: measures the mesh and writes its files.
  void finish(const Cell& cell);
  /// Records a cell whose process did not finish.
  void fail(const Cell& cell, const ProcessFailure& why) const;
  /// Writes a record with the reason for a missing mesh, and the input and output of a peer. An interrupted
  /// cell, which is still to do, gets nothing.
  void give_up(const Cell& cell, const std::string& status, const ProcessFailure& why) const;
};

}  // namespace delquad
