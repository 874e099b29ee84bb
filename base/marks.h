// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

// This header marks numbered things. Stages that walk over meshes use it.

namespace delquad {

/// Marks of numbered things that were met in this pass. A new pass costs nothing.
class Marks {
 public:
  /// Starts a pass over n things, none of them met.
  void begin(std::size_t n) {
    ++pass_;
    met_.resize(n, 0);
  }
  /// Returns whether i in [0, n) is met for the first time in this pass, and marks it.
  bool meet(int i) {
    assert(i >= 0 && i < static_cast<int>(met_.size()));
    return std::exchange(met_[i], pass_) != pass_;
  }

 private:
  std::vector<unsigned> met_;  ///< last pass that met each thing
  unsigned pass_ = 0;
};

}  // namespace delquad
