#pragma once

#include <cassert>
#include <cstddef>
#include <numeric>
#include <vector>

namespace delquad {

/// Sets of the numbers 0, 1, ..., at first of one each, that grow together. A set goes by one of its numbers,
/// its root.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n = 0) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t size() const { return parent_.size(); }
  /// One more number, which it returns.
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  int root(int i) {
    assert(i >= 0 && i < static_cast<int>(parent_.size()));
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// False where both were in one set. The lower one of their roots is that of both.
  bool join(int i, int j) {
    i = root(i), j = root(j);
    return i < j ? join_to(i, j) : join_to(j, i);
  }
  /// The same, but the root is the first's.
  bool join_to(int i, int j) {
    i = root(i), j = root(j);
    parent_[j] = i;
    return i != j;
  }
  /// Of each number.
  std::vector<int> roots() {
    std::vector<int> all = parent_;
    for (int& i : all) i = root(i);
    return all;
  }

  /// Of each number the place of its set among all, which are in the order of their first members.
  std::vector<int> places() {
    std::vector<int> place(parent_.size(), -1);
    int n = 0;
    for (int i = 0; i < static_cast<int>(place.size()); ++i) {
      int& of_set = place[root(i)];
      if (of_set < 0) of_set = n++;
      place[i] = of_set;
    }
    return place;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace delquad
