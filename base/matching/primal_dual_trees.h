#pragma once

#include <cstddef>
#include <vector>

#include "base/matching/primal_dual_search.h"
#include "base/sort_unique.h"

/// The part of the search in which trees grow, end, stop and are left.
namespace delquad {

/// The edge from v, which is even, to w, which is even or in no tree, is tight.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::meet(int v, int w) {
  const int c = s_.nodes[v].container, d = s_.nodes[w].container;
  const int tree = s_.nodes[c].tree, other = s_.nodes[d].tree;
  if (s_.nodes[d].label == 0) {
    if (!s_.movable(d, range_->begin, range_->end)) return stop(tree);
    if (s_.matched(d)) return grow(v, w);
    flip(v, w);
    s_.match(v, w);
    loose_.push_back(d);
    --growing_;
    dissolve(tree);
  } else {
    if (tree == other) return contract(v, w);
    growing_ -= s_.nodes[d].rate > 0 ? 2 : 1;
    flip(v, w);
    flip(w, v);
    dissolve(tree);
    dissolve(other);
  }
  settle();
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::grow(int v, int w) {
  const int d = s_.nodes[w].container, tree = s_.nodes[s_.nodes[v].container].tree;
  s_.nodes[d].outer = v;
  s_.nodes[d].inner = w;
  join(d, -1, tree);
  if (s_.nodes[d].blossom >= 0) queue_.push(time_ + dual(d), d, kVanish);
  const int e = s_.nodes[s_.nodes[s_.nodes[d].base].mate].container;
  join(e, 1, tree);
  scan_all(e);
}

/// Matches v, which is even, with w, and all else on the path from v to its root anew.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::flip(int v, int w) {
  for (;;) {
    auto& mine = s_.nodes[s_.nodes[v].container];
    const int mate = s_.nodes[mine.base].mate;
    mine.base = v;
    s_.nodes[v].mate = w;
    if (mate < 0) return;
    auto& odd = s_.nodes[s_.nodes[mate].container];
    odd.base = odd.inner;
    s_.nodes[odd.inner].mate = odd.outer;
    w = odd.inner;
    v = odd.outer;
  }
}

/// Makes an even container free in place of its root.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::free_base(int container) {
  const int base = s_.nodes[container].base, mate = s_.nodes[base].mate;
  if (mate < 0) return;
  s_.nodes[base].mate = -1;
  auto& odd = s_.nodes[s_.nodes[mate].container];
  odd.base = odd.inner;
  s_.nodes[odd.inner].mate = odd.outer;
  flip(odd.outer, odd.inner);
}

/// The tree has met what may not change now: it stays as it is until this search is over, or another tree
/// meets it.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::stop(int tree) {
  --growing_;
  stopped_.push_back({tree, members_.birth(tree)});
  members_.collect(tree, released_);
  for (std::size_t i = 0; i < released_.size(); ++i) {
    if (i + kFetchAhead < released_.size()) __builtin_prefetch(&s_.nodes[released_[i + kFetchAhead]]);
    const int c = released_[i];
    Node& node = s_.nodes[c];
    if (node.container != c || node.tree != tree || node.rate == 0) continue;
    node.offset += node.rate * time_;
    node.rate = 0;
    if (node.missed) missed_.push_back(c);
  }
  notice_missed();
}

/// The containers of the tree are in none any more.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::dissolve(int tree) {
  members_.collect(tree, released_);
  members_.drop(tree);
  for (std::size_t i = 0; i < released_.size(); ++i) {
    if (i + kFetchAhead < released_.size()) __builtin_prefetch(&s_.nodes[released_[i + kFetchAhead]]);
    const int c = released_[i];
    Node& node = s_.nodes[c];
    if (node.container != c || node.tree != tree || node.label == 0) continue;
    set_label(c, 0);
    node.tree = -1;
    if (node.missed) missed_.push_back(c);
    if (node.blossom >= 0) loose_.push_back(c);
  }
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::notice_missed() {
  for (const int c : missed_) {
    s_.nodes[c].missed = false;
    if (growing_ > 0) s_.each_node(c, [&](int v) { scan_missed(v); });
  }
  missed_.clear();
}

/// What is left to do once trees were dissolved. Blossoms whose dual value is zero hold nothing together.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::settle() {
  notice_missed();
  while (!loose_.empty()) {
    const int c = loose_.back();
    loose_.pop_back();
    if (s_.nodes[c].blossom < 0 || !s_.matched(c) || dual(c) != 0) continue;
    for (const Child& child : s_.expand(c, offset(s_.nodes[c]))) {
      if (child.blossom >= 0) loose_.push_back(child.container);
    }
  }
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::release_all() {
  for (const auto& [tree, birth] : stopped_) {
    if (members_.birth(tree) == birth) dissolve(tree);
  }
  stopped_.clear();
  settle();
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::leave_free_ones() {
  std::vector<int>& roots = range_->roots;
  roots.insert(roots.end(), parked_.begin(), parked_.end());
  for (int& v : roots) {
    const int c = s_.nodes[v].container;
    v = s_.matched(c) ? -1 : s_.nodes[c].base;
  }
  sort_unique(roots);
  if (!roots.empty() && roots[0] < 0) roots.erase(roots.begin());
}

/// Trees that cannot grow: without their odd nodes, each of their even containers is a component for itself.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::find_witness() {
  range_->outcome = SearchOutcome::kStuck;
  for (int v = range_->begin; v < range_->end; ++v) {
    if (s_.nodes[s_.nodes[v].container].rate < 0) range_->witness.push_back(v);
  }
}

}  // namespace delquad
