// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"

// This header searches items by bounding boxes. Most modules use it.

namespace delquad {

/// Binary tree of boxes over numbered items with bounding boxes, halved at the median along the longest axis.
template <class V>
class BoxTree {
 public:
  struct Node {
    Box<V> box;
    int begin, end;  ///< range of items in the order of the tree
    int right;       ///< second child (the first is the next node); -1: a leaf
  };

  BoxTree() = default;
  /// `boxes[i]` bounds item i.
  explicit BoxTree(const std::vector<Box<V>>& boxes) : items_(boxes.size()) {
    std::iota(items_.begin(), items_.end(), 0);
    if (!items_.empty()) build(boxes, 0, static_cast<int>(items_.size()));
  }

  /// Returns the nodes, the root first; empty without items.
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> items(const Node& node) const {
    return std::span(items_).subspan(node.begin, node.end - node.begin);
  }

  /// Calls visit(item) for the items of all leaves whose bound(node) is at most `limit`, lower bounds first.
  /// visit() may lower the limit. The bound of a node must not exceed the bounds of its children.
  template <class Bound, class Visit>
  void search(const double& limit, Bound bound, Visit visit) const {
    if (nodes_.empty()) return;
    std::array<std::pair<double, int>, kMostWaiting> waiting;
    int n = 0;
    waiting[n++] = {bound(nodes_[0]), 0};
    while (n > 0) {
      const auto [least, index] = waiting[--n];
      if (least > limit) continue;
      const Node& node = nodes_[index];
      if (node.right < 0) {
        for (const int item : items(node)) visit(item);
        continue;
      }
      assert(n + 2 <= kMostWaiting);
      waiting[n] = {bound(nodes_[node.right]), node.right};
      waiting[n + 1] = {bound(nodes_[index + 1]), index + 1};
      assert(waiting[n].first >= least && waiting[n + 1].first >= least);
      if (waiting[n + 1].first > waiting[n].first) std::swap(waiting[n], waiting[n + 1]);
      n += 2;
    }
  }

  /// Calls visit(item) for the items of leaves within a distance of x, near leaves first. `limit2` is the
  /// square of this distance.
  template <class Visit>
  void nearest(const V& x, const double& limit2, Visit visit) const {
    search(
        limit2, [&](const Node& node) { return node.box.distance2(x); }, visit);
  }

  /// Calls visit(item) for the items of all leaves whose boxes share a point with `box`.
  template <class Visit>
  void overlapping(const Box<V>& box, Visit visit) const {
    search(
        0.0, [&](const Node& node) { return node.box.overlaps(box) ? 0.0 : 1.0; }, visit);
  }

 private:
  static constexpr int kLeafSize = 4;
  /// Halving leaves fewer than 32 levels, each with one waiting node.
  static constexpr int kMostWaiting = 40;

  int build(const std::vector<Box<V>>& boxes, int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    Box<V> box = boxes[items_[begin]];
    for (int i = begin; i < end; ++i)
      box = {lower(box.low, boxes[items_[i]].low), upper(box.high, boxes[items_[i]].high)};
    nodes_.push_back({box, begin, end, -1});
    if (end - begin <= kLeafSize) return index;

    int axis = 0;
    for (int k = 1; k < Box<V>::kAxes; ++k)
      if (coordinate(box.high, k) - coordinate(box.low, k) >
          coordinate(box.high, axis) - coordinate(box.low, axis))
        axis = k;
    const auto key = [&](int i) {
      return std::pair(coordinate(boxes[i].low, axis) + coordinate(boxes[i].high, axis), i);
    };
    const int middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](int a, int b) { return key(a) < key(b); });
    build(boxes, begin, middle);
    const int right = build(boxes, middle, end);
    nodes_[index].right = right;
    return index;
  }

  std::vector<int> items_;
  std::vector<Node> nodes_;
};

}  // namespace delquad
