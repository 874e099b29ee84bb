// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <numeric>
#include <vector>

// This header joins sets. Components of meshes and graphs use it.

namespace delquad {

/// Sets of the numbers 0, 1, ..., initially of one each, that grow together. The root of a set is one of its
/// numbers.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n = 0) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t size() const { return parent_.size(); }
  /// Adds a number, and returns it.
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  /// Returns the root of the set of a number in [0, size()).
  int root(int i) {
    assert(i >= 0 && i < static_cast<int>(parent_.size()));
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins two sets; the lower root remains. Returns false if they are one set already.
  bool join(int i, int j) {
    i = root(i), j = root(j);
    return i < j ? join_to(i, j) : join_to(j, i);
  }
  /// Joins two sets; the root of the first remains.
  bool join_to(int i, int j) {
    i = root(i), j = root(j);
    parent_[j] = i;
    return i != j;
  }
  /// Returns the root of each number.
  std::vector<int> roots() {
    std::vector<int> all = parent_;
    for (int& i : all) i = root(i);
    return all;
  }

  /// Returns the index of each number's set, in the order of first members.
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
