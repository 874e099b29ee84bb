#pragma once

#include <utility>
#include <vector>

#include "base/cancel.h"
#include "matching/primal_dual_state.h"
#include "matching/radix_queue.h"
#include "matching/tree_members.h"

namespace delquad {

enum class SearchOutcome {
  kDone,
  kStuck,     ///< some trees can neither grow nor end: there is no perfect matching
  kOverflow,  ///< times leave the range of the numbers
};

/// Trees of alternating paths that grow from all free containers of a range of nodes at once and at one
/// speed, until each has ended: at another tree or a free container (both are matched then), or at an odd
/// cycle that is left as a free blossom (`park`), or where it would have to leave the range. docs/matching.md
/// says more.
template <class Value, class Cost>
class PrimalDualSearch {
 public:
  PrimalDualSearch(PrimalDualState<Value, Cost>& state, Value time_limit) : s_(state), limit_(time_limit) {}

  /// `roots`: a node in each container to start from; `modulus`: such that totals of the nodes of roots that
  /// agree in their remainders keep all times integral. Leaves those that are free in the end in `roots`.
  SearchOutcome run(int begin, int end, bool park, int modulus, std::vector<int>& roots);

 private:
  using State = PrimalDualState<Value, Cost>;
  using Node = typename State::Node;
  using Child = typename State::Child;
  using Event = typename RadixQueue<Value>::Event;
  struct Step {
    int container, end, next;  ///< on a path to the root, and the edge to the one after
  };
  static constexpr std::size_t kFetchAhead = 12;   ///< entries of a list that are read one by one
  static constexpr int kStart = -1, kVanish = -2;  ///< in place of an arc

  bool in_range(int v) const { return v >= begin_ && v < end_; }
  bool inside(int container) const {
    const int b = s_.nodes[container].blossom;
    return b < 0 || (s_.blossoms[b].lowest >= begin_ && s_.blossoms[b].highest < end_);
  }
  /// A container that this range may change, and so the one that it is matched with.
  bool movable(int container) const {
    if (!inside(container)) return false;
    const int mate = s_.nodes[s_.nodes[container].base].mate;
    return mate < 0 || (in_range(mate) && inside(s_.nodes[mate].container));
  }
  Value offset(const Node& container) const { return container.offset + container.rate * time_; }
  Value total(int v) const { return s_.nodes[v].value + offset(s_.nodes[s_.nodes[v].container]); }
  Value slack(int v, const typename State::Arc& arc) const { return arc.cost - total(v) - total(arc.to); }
  Value dual(int container) const {
    const Node& node = s_.nodes[container];
    return offset(node) - s_.blossoms[node.blossom].origin;
  }

  void set_label(int container, int label) {
    Node& node = s_.nodes[container];
    node.offset += (node.rate - label) * time_;
    node.label = node.rate = static_cast<signed char>(label);
  }
  void join(int container, int label, int tree) {
    set_label(container, label);
    s_.nodes[container].tree = tree;
    members_.add(tree, container);
  }

  /// Starts to read a node from memory, of two cache lines.
  void fetch(int v) const {
    __builtin_prefetch(&s_.nodes[v]);
    __builtin_prefetch(&s_.nodes[v].own_arcs);
  }
  void start(int v);
  void scan(int v);
  void scan_missed(int v);
  void scan_all(int container) {
    s_.each_node(container, [&](int v) { scan(v); });
  }
  void follow(int v, int arc);
  void meet(int v, int w);
  void grow(int v, int w);
  void flip(int v, int w);
  void free_base(int container);
  void stop(int tree);
  void dissolve(int tree);
  void settle();
  void notice_missed();
  void release_all();
  void leave_free_ones(std::vector<int>& roots);
  void find_witness();

  void contract(int v, int w);
  void park_cycle(int container);
  int common_container(int a, int b);
  void climb(int from, int to, std::vector<Step>& path) const;
  void list_children(int v, int w, int common, std::vector<Child>& children);
  void join_lists(int blossom);
  void relabel(int blossom, int container);
  void expand_odd(int container);

  State& s_;
  Value limit_;
  RadixQueue<Value> queue_;
  TreeMembers members_;
  Value time_ = 0;
  int begin_ = 0, end_ = 0;
  bool park_ = false;
  int waiting_ = 0;                                 ///< roots that have not started
  int growing_ = 0;                                 ///< trees
  unsigned events_ = 0;                             ///< that have come, modulo 2^32
  std::vector<std::pair<int, long long>> stopped_;  ///< trees with their births
  std::vector<int> released_, missed_, loose_, parked_;
  std::vector<Step> path_a_, path_b_;
  std::vector<std::pair<int, int>> were_odd_;  ///< first and last nodes of lists
};

template <class Value, class Cost>
SearchOutcome PrimalDualSearch<Value, Cost>::run(int begin, int end, bool park, int modulus,
                                                 std::vector<int>& roots) {
  begin_ = begin;
  end_ = end;
  park_ = park;
  time_ = 0;
  queue_.reset();
  waiting_ = growing_ = 0;
  parked_.clear();
  for (const int v : roots) {
    const int c = s_.nodes[v].container;
    if (s_.matched(c) || !inside(c)) continue;
    const Value remainder = total(v) % modulus;
    queue_.push(remainder < 0 ? remainder + modulus : remainder, v, kStart);
    ++waiting_;
  }
  Event event;
  while (growing_ + waiting_ > 0) {
    if (++events_ % kPerCheck == 0) check_cancelled();
    if (!queue_.pop(event)) {
      find_witness();
      return SearchOutcome::kStuck;
    }
    time_ = event.time;
    if (time_ > limit_) return SearchOutcome::kOverflow;
    if (event.arc >= 0) {
      follow(event.node, event.arc);
    } else if (event.arc == kStart) {
      start(event.node);
    } else {
      const Node& node = s_.nodes[event.node];
      if (node.container == event.node && node.rate < 0 && node.blossom >= 0 && dual(event.node) == 0) {
        expand_odd(event.node);
      }
    }
  }
  release_all();
  leave_free_ones(roots);
  limit_ -= time_;
  return SearchOutcome::kDone;
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::start(int v) {
  --waiting_;
  const int c = s_.nodes[v].container;
  if (s_.matched(c)) return;
  ++growing_;
  join(c, 1, members_.make());
  scan_all(c);
}

/// Events for the edges of a node that has become even.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::scan(int v) {
  const Value mine = total(v);
  const int c = s_.nodes[v].container, tree = s_.nodes[c].tree;
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  const int degree = s_.nodes[v].degree;
  for (int a = 0; a < degree; ++a) {
    const int w = arcs[a].to, d = s_.nodes[w].container;
    if (d == c) continue;
    Node& other = s_.nodes[d];
    if (other.rate < 0) {
      // A node in this tree stays odd for as long as this one is even.
      if (other.tree != tree || other.blossom >= 0) other.missed = true;
      continue;
    }
    if (other.mate >= 0) fetch(other.mate);  // where the tree may grow to next
    const Value slack = arcs[a].cost - mine - (s_.nodes[w].value + offset(other));
    queue_.push(time_ + (other.rate > 0 ? slack / 2 : slack), v, a);
  }
}

/// Events for the edges of a node that is odd no more, or does not change any more, with nodes that are even.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::scan_missed(int v) {
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  for (int a = 0; a < s_.nodes[v].degree; ++a) {
    const int w = arcs[a].to;
    if (in_range(w) && s_.nodes[s_.nodes[w].container].rate > 0) queue_.push(time_ + slack(v, arcs[a]), v, a);
  }
}

/// An edge that may have become tight.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::follow(int v, int arc) {
  const auto& edge = s_.arcs_of(s_.nodes[v])[arc];
  int w = edge.to;
  if (s_.nodes[v].container == s_.nodes[w].container) return;
  const Value left = slack(v, edge);
  const int from = v;
  if (s_.nodes[s_.nodes[v].container].rate <= 0) std::swap(v, w);
  const Node& mine = s_.nodes[s_.nodes[v].container];
  if (mine.rate <= 0) return;
  Node& other = s_.nodes[s_.nodes[w].container];
  if (other.rate < 0) {
    if (other.tree != mine.tree || other.blossom >= 0) other.missed = true;
  } else if (left != 0) {
    queue_.push(time_ + (other.rate > 0 ? left / 2 : left), from, arc);
  } else if (!in_range(w) || other.label < 0) {
    stop(mine.tree);
  } else {
    meet(v, w);
  }
}

/// The edge from v, which is even, to w, which is even or in no tree, is tight.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::meet(int v, int w) {
  const int c = s_.nodes[v].container, d = s_.nodes[w].container;
  const int tree = s_.nodes[c].tree, other = s_.nodes[d].tree;
  if (s_.nodes[d].label == 0) {
    if (!movable(d)) return stop(tree);
    if (s_.matched(d)) return grow(v, w);
    ++s_.augmentations;
    flip(v, w);
    s_.match(v, w);
    loose_.push_back(d);
    --growing_;
    dissolve(tree);
  } else {
    if (tree == other) return contract(v, w);
    ++s_.augmentations;
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
void PrimalDualSearch<Value, Cost>::leave_free_ones(std::vector<int>& roots) {
  roots.insert(roots.end(), parked_.begin(), parked_.end());
  for (int& v : roots) {
    const int c = s_.nodes[v].container;
    v = s_.matched(c) ? -1 : s_.nodes[c].base;
  }
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  if (!roots.empty() && roots[0] < 0) roots.erase(roots.begin());
}

/// Trees that cannot grow: without their odd nodes, each of their even containers is a component for itself.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::find_witness() {
  for (int v = begin_; v < end_; ++v) {
    if (s_.nodes[s_.nodes[v].container].rate < 0) s_.witness.push_back(v);
  }
}

}  // namespace delquad
