// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/matching/primal_dual_search.h"
#include "base/matching/primal_dual_state.h"
#include "base/parallel.h"
#include "base/parallel_collect.h"
#include "base/sort_unique.h"

// This header has the part of the search that grows, ends and stops trees, and its levels. The primal-dual
// solver uses it.

namespace delquad {

/// Handles a tight edge from v, which is even, to w, which is even or in no tree.
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

/// Adds the container of w as odd and its mate as even to the tree of v.
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

/// Matches v, which is even, with w, and rematches the path from v to its root.
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

/// Stops a tree that met nodes which may not change now. It stays until this search ends, or another tree
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

/// Removes the containers of a tree from it.
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

/// Looks again at containers whose events were dropped while they were odd.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::notice_missed() {
  for (const int c : missed_) {
    s_.nodes[c].missed = false;
    if (growing_ > 0) s_.each_node(c, [&](int v) { scan_missed(v); });
  }
  missed_.clear();
}

/// Finishes after trees were dissolved: opens free blossoms whose dual value is zero.
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

/// Dissolves the trees that stopped.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::release_all() {
  for (const auto& [tree, birth] : stopped_) {
    if (members_.birth(tree) == birth) dissolve(tree);
  }
  stopped_.clear();
  settle();
}

/// Replaces the range's roots by a node of each container that is still free.
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

/// Collects a witness from trees that cannot grow: without their odd nodes, each even container is a
/// component.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::find_witness() {
  range_->outcome = SearchOutcome::kStuck;
  for (int v = range_->begin; v < range_->end; ++v) {
    if (s_.nodes[s_.nodes[v].container].rate < 0) range_->witness.push_back(v);
  }
}

/// Contracts the odd cycle of a tight edge between v and w, both even and in one tree.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::contract(int v, int w) {
  ++range_->contractions;
  const int common = common_container(s_.nodes[v].container, s_.nodes[w].container);
  const int base = s_.nodes[common].base, tree = s_.nodes[common].tree;
  const int b = s_.blossoms.make();
  list_children(v, w, common, s_.blossoms[b].children);
  join_lists(b);

  // The blossom takes the number of its largest part, whose nodes then need no update.
  int container = common, largest = 0;
  bool missed = false;
  were_odd_.clear();
  for (const Child& child : s_.blossoms[b].children) {
    const Node& node = s_.nodes[child.container];
    missed = missed || node.missed;
    if (node.label < 0) were_odd_.push_back({s_.first_node(child), s_.last_node(child)});
    const int size = child.blossom < 0 ? 1 : s_.blossoms[child.blossom].size;
    if (size <= largest) continue;
    largest = size;
    container = child.container;
  }
  relabel(b, container);
  Node& node = s_.nodes[container];
  s_.blossoms[b].origin = offset(node);
  node.blossom = b;
  node.tree = tree;
  node.missed = park_ && missed;
  s_.nodes[container].base = base;
  set_label(container, 1);
  if (park_) return park_cycle(container);
  for (const auto& [first, last] : were_odd_) s_.each_in_list(first, last, [&](int x) { scan(x); });
}

/// Ends the tree; its new blossom is free.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::park_cycle(int container) {
  free_base(container);
  parked_.push_back(s_.nodes[container].base);
  --growing_;
  dissolve(s_.nodes[container].tree);
  settle();
}

/// Returns the first even container that the paths from a and b to their root share.
template <class Value, class Cost>
int PrimalDualSearch<Value, Cost>::common_container(int a, int b) {
  if (mark_ == last_mark_) {
    mark_ = s_.marks.fetch_add(kMarksAtOnce);
    last_mark_ = mark_ + kMarksAtOnce;
  }
  const int mark = ++mark_;
  for (;;) {
    if (a >= 0) {
      if (s_.nodes[a].mark == mark) return a;
      s_.nodes[a].mark = mark;
      const int mate = s_.nodes[s_.nodes[a].base].mate;
      a = mate < 0 ? -1 : s_.nodes[s_.nodes[s_.nodes[mate].container].outer].container;
    }
    std::swap(a, b);
  }
}

/// Lists the containers from an even one up to another (excluded), each with the edge to the next.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::climb(int from, int to, std::vector<Step>& path) const {
  path.clear();
  while (from != to) {
    const int base = s_.nodes[from].base, mate = s_.nodes[base].mate, odd = s_.nodes[mate].container;
    path.push_back({from, base, mate});
    path.push_back({odd, s_.nodes[odd].inner, s_.nodes[odd].outer});
    from = s_.nodes[s_.nodes[odd].outer].container;
  }
}

/// Lists the cycle: from the common container down to v, over to w, and up again.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::list_children(int v, int w, int common, std::vector<Child>& children) {
  climb(s_.nodes[v].container, common, path_a_);
  climb(s_.nodes[w].container, common, path_b_);
  children.clear();
  int container = common;
  for (std::size_t i = path_a_.size(); i-- > 0;) {
    children.push_back({s_.nodes[container].blossom, container, path_a_[i].next, path_a_[i].end});
    container = path_a_[i].container;
  }
  children.push_back({s_.nodes[container].blossom, container, v, w});
  for (const Step& step : path_b_) {
    children.push_back({s_.nodes[step.container].blossom, step.container, step.end, step.next});
  }
}

/// Joins the node lists of the children, and stores the children's dual values.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::join_lists(int blossom) {
  auto& whole = s_.blossoms[blossom];
  whole.size = 0;
  whole.lowest = s_.n_nodes;
  whole.highest = -1;
  for (const Child& child : whole.children) {
    const int first = s_.first_node(child);
    if (child.blossom < 0) {
      whole.size += 1;
      whole.lowest = std::min(whole.lowest, first);
      whole.highest = std::max(whole.highest, first);
    } else {
      auto& part = s_.blossoms[child.blossom];
      part.dual = dual(child.container);
      whole.size += part.size;
      whole.lowest = std::min(whole.lowest, part.lowest);
      whole.highest = std::max(whole.highest, part.highest);
    }
    if (&child == &whole.children.front()) {
      whole.first = first;
    } else {
      s_.next[whole.last] = first;
    }
    whole.last = s_.last_node(child);
  }
}

/// Moves the nodes of all children to the container of one of them. Their totals do not change.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::relabel(int blossom, int container) {
  const Value kept = offset(s_.nodes[container]);
  for (const Child& child : s_.blossoms[blossom].children) {
    if (child.container == container) continue;
    Node& part = s_.nodes[child.container];
    const Value difference = offset(part) - kept;
    part.label = part.rate = 0;
    part.missed = false;
    s_.each_in_list(s_.first_node(child), s_.last_node(child), [&](int x) {
      s_.nodes[x].value += difference;
      s_.nodes[x].container = container;
    });
  }
}

/// Opens an odd blossom whose dual value is zero. The part of its cycle that connects the tree stays in it.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::expand_odd(int container) {
  ++range_->expansions;
  const int tree = s_.nodes[container].tree, base = s_.nodes[container].base;
  int outer = s_.nodes[container].outer, inner = s_.nodes[container].inner;
  const bool missed = s_.nodes[container].missed;
  const std::vector<Child> children = s_.expand(container, offset(s_.nodes[container]));
  const int k = static_cast<int>(children.size());
  const int last = State::index_of(children, s_.nodes[base].container);
  int i = State::index_of(children, s_.nodes[inner].container);
  // Goes towards the base by an even number of links.
  const bool forwards = (i - last + k) % k % 2 == 1;
  const int step = forwards ? 1 : k - 1;
  for (;;) {
    const int c = children[i].container;
    s_.nodes[c].outer = outer;
    s_.nodes[c].inner = inner;
    join(c, -1, tree);
    s_.nodes[c].missed = missed;
    if (children[i].blossom >= 0) queue_.push(time_ + dual(c), c, kVanish);
    if (i == last) break;
    const int even = (i + step) % k;
    join(children[even].container, 1, tree);
    i = (even + step) % k;
    const Child& link = children[forwards ? even : i];
    outer = forwards ? link.end : link.next;
    inner = forwards ? link.next : link.end;
  }
  for (const Child& child : children) {
    const int c = child.container;
    if (s_.nodes[c].label > 0) scan_all(c);
    if (s_.nodes[c].label == 0 && missed) s_.each_node(c, [&](int v) { scan_missed(v); });
  }
}

/// Searches ranges of nodes, one level at a time in parallel, with larger ranges in each level. Ranges do not
/// depend on the number of threads, and searches of a level do not see each other. So the result does not
/// depend on it either.
template <class Value, class Cost>
class PrimalDualLevels {
 public:
  PrimalDualLevels(PrimalDualState<Value, Cost>& state, Value time_limit) : s_(state), limit_(time_limit) {
    note_border();
  }

  /// Runs all levels; `park` and `modulus` are as for PrimalDualSearch.
  SearchOutcome run(bool park, int modulus);

  std::vector<int> witness;  ///< proof of a search that there is no perfect matching
  long long contractions = 0, expansions = 0;

 private:
  using Search = PrimalDualSearch<Value, Cost>;
  using Border = BorderNode<Value>;

  /// Nodes of the smallest ranges, whose part of the graph stays in a fast cache.
  static constexpr int kFirstRange = 4096;
  /// Ranges of one level that form one of the next.
  static constexpr int kFactor = 8;

  void note_border();
  bool has_arc_out(int v, long long range) const;
  Value cap(int v, long long range) const;
  std::vector<SearchRange<Value>> ranges_with_roots(long long length) const;
  void give_borders(long long length, std::vector<SearchRange<Value>>& ranges,
                    std::vector<Border>& border) const;
  void search(SearchRange<Value>& range, bool park, int modulus);
  SearchOutcome collect(std::vector<SearchRange<Value>>& ranges);

  PrimalDualState<Value, Cost>& s_;
  Value limit_;
  std::vector<int> border_;  ///< nodes with neighbors outside their smallest range
  std::vector<std::unique_ptr<Search>> idle_;
  std::mutex mutex_;
};

template <class Value, class Cost>
SearchOutcome PrimalDualLevels<Value, Cost>::run(bool park, int modulus) {
  const long long n = s_.n_nodes;
  for (long long length = std::min<long long>(kFirstRange, n);; length = std::min(length * kFactor, n)) {
    std::vector<SearchRange<Value>> ranges = ranges_with_roots(length);
    std::vector<Border> border;
    if (length < n) give_borders(length, ranges, border);
    parallel_for(
        ranges.size(), [&](std::size_t i) { search(ranges[i], park, modulus); },
        [&](std::size_t i) { return static_cast<double>(ranges[i].roots.size()); });
    const SearchOutcome outcome = collect(ranges);
    if (outcome != SearchOutcome::kDone || length == n) return outcome;
  }
}

/// Returns whether a node has a neighbor outside its range of this length.
template <class Value, class Cost>
bool PrimalDualLevels<Value, Cost>::has_arc_out(int v, long long range) const {
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  const long long begin = v / range * range;
  return std::any_of(arcs, arcs + s_.nodes[v].degree,
                     [&](const auto& arc) { return arc.to < begin || arc.to >= begin + range; });
}

/// Lists the nodes with neighbors outside their smallest range.
template <class Value, class Cost>
void PrimalDualLevels<Value, Cost>::note_border() {
  border_ = parallel_collect<int>(s_.nodes.size(),
                                  [&](std::size_t begin, std::size_t end, std::vector<int>& border) {
                                    for (std::size_t v = begin; v < end; ++v) {
                                      if (has_arc_out(static_cast<int>(v), kFirstRange))
                                        border.push_back(static_cast<int>(v));
                                    }
                                  });
}

/// Returns the limit of a node's total, so that no slack to other ranges becomes negative.
template <class Value, class Cost>
Value PrimalDualLevels<Value, Cost>::cap(int v, long long range) const {
  Value least = limit_;
  const Value mine = s_.total(v);
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  for (int a = 0; a < s_.nodes[v].degree; ++a) {
    const int w = arcs[a].to;
    const long long begin = w / range * range;
    if (v >= begin && v < begin + range) continue;
    const Value slack = arcs[a].cost - mine - s_.total(w);
    const bool fixed = !s_.movable(s_.nodes[w].container, static_cast<int>(begin),
                                   static_cast<int>(std::min<long long>(begin + range, s_.n_nodes)));
    least = std::min(least, fixed ? slack : slack / 2);
  }
  return mine + least;
}

/// Returns the ranges of this length that have free nodes.
template <class Value, class Cost>
std::vector<SearchRange<Value>> PrimalDualLevels<Value, Cost>::ranges_with_roots(long long length) const {
  std::vector<SearchRange<Value>> ranges;
  for (const int v : s_.free_nodes) {
    if (ranges.empty() || v >= ranges.back().end) {
      const long long begin = v / length * length;
      ranges.push_back(
          {static_cast<int>(begin), static_cast<int>(std::min<long long>(begin + length, s_.n_nodes))});
    }
    ranges.back().roots.push_back(v);
  }
  return ranges;
}

/// Gives each range its border; `border` has the storage.
template <class Value, class Cost>
void PrimalDualLevels<Value, Cost>::give_borders(long long length, std::vector<SearchRange<Value>>& ranges,
                                                 std::vector<Border>& border) const {
  border.reserve(border_.size());
  for (auto& range : ranges) {
    const std::size_t first = border.size();
    for (auto v = std::ranges::lower_bound(border_, range.begin); v != border_.end() && *v < range.end; ++v) {
      if (has_arc_out(*v, length)) border.push_back({*v, cap(*v, length)});
    }
    range.border = std::span(border).subspan(first);
  }
}

/// Searches a range, with an idle search if there is one.
template <class Value, class Cost>
void PrimalDualLevels<Value, Cost>::search(SearchRange<Value>& range, bool park, int modulus) {
  std::unique_ptr<Search> search;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      search = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!search) search = std::make_unique<Search>(s_);
  search->run(range, limit_, park, modulus);
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(search));
}

/// Combines the results of all ranges, in order.
template <class Value, class Cost>
SearchOutcome PrimalDualLevels<Value, Cost>::collect(std::vector<SearchRange<Value>>& ranges) {
  s_.free_nodes.clear();
  Value time = 0;
  for (auto& range : ranges) {
    contractions += range.contractions;
    expansions += range.expansions;
    if (range.outcome == SearchOutcome::kStuck) witness = std::move(range.witness);
    if (range.outcome != SearchOutcome::kDone) return range.outcome;
    time = std::max(time, range.time);
    s_.free_nodes.insert(s_.free_nodes.end(), range.roots.begin(), range.roots.end());
  }
  std::ranges::sort(s_.free_nodes);
  limit_ -= time;
  return SearchOutcome::kDone;
}

}  // namespace delquad
