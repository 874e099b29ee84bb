#pragma once

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace delquad {

/// Which of some numbered things have been met in this pass. To begin another one costs nothing.
class Marks {
 public:
  /// Nothing has been met; there are n things.
  void begin(std::size_t n) {
    ++pass_;
    met_.resize(n, 0);
  }
  /// Whether this is the first time in this pass.
  bool meet(int i) {
    assert(i >= 0 && i < static_cast<int>(met_.size()));
    return std::exchange(met_[i], pass_) != pass_;
  }

 private:
  std::vector<unsigned> met_;  ///< the last pass in which each was met
  unsigned pass_ = 0;
};

}  // namespace delquad
