// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "base/matching/primal_dual_state.h"

// This header searches augmenting paths by growing trees. The primal-dual solver uses it.

namespace delquad {

/// Queue of events by time, and by insertion for equal times: a radix heap. Times are >= 0 and never before
/// the last popped event, so an event moves at most once for each bit of its time.
template <class Time>
class RadixQueue {
 public:
  struct Event {
    Time time;
    int node;
    int arc;
  };

  void push(Time time, int node, int arc) { put({time, node, arc}); }

  /// Returns false if no event is left.
  bool pop(Event& event) {
    std::vector<Event>& now = buckets_[0];
    if (next_ == now.size()) {
      now.clear();
      next_ = 0;
      if (!refill()) return false;
    }
    event = now[next_++];
    return true;
  }

  /// Drops all events and restarts at time zero.
  void reset() {
    for (int k = 0; k < kBuckets; ++k) buckets_[k].clear();
    for (std::uint64_t& word : used_) word = 0;
    next_ = 0;
    last_ = 0;
  }

 private:
  static constexpr int kBuckets = 8 * sizeof(Time) + 1;
  static constexpr int kWords = (kBuckets + 63) / 64;

  /// Returns one more than the highest bit in which a time differs from the last one; 0 if none does.
  static int bucket(Time difference) {
    if constexpr (sizeof(Time) > 8) {
      const auto high = static_cast<std::uint64_t>(difference >> 64);
      if (high != 0) return 64 + static_cast<int>(std::bit_width(high));
    }
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(difference)));
  }

  void put(const Event& event) {
    const int k = bucket(event.time ^ last_);
    buckets_[k].push_back(event);
    if (k > 0) used_[k / 64] |= std::uint64_t{1} << (k % 64);
  }

  /// Moves the events of the next time to bucket 0.
  bool refill() {
    for (int word = 0; word < kWords; ++word) {
      if (used_[word] == 0) continue;
      const int k = 64 * word + std::countr_zero(used_[word]);
      std::vector<Event>& events = buckets_[k];
      last_ = events[0].time;
      for (const Event& e : events) last_ = std::min(last_, e.time);
      for (const Event& e : events) put(e);  // each goes to a lower bucket
      events.clear();
      used_[word] &= ~(std::uint64_t{1} << (k % 64));
      return true;
    }
    return false;
  }

  std::vector<Event> buckets_[kBuckets];
  std::uint64_t used_[kWords] = {};
  std::size_t next_ = 0;
  Time last_ = 0;
};

/// Containers of many trees; each tree is a list of reusable blocks of one cache line.
class TreeMembers {
 public:
  /// Makes an empty list.
  int make() {
    int tree;
    if (unused_.empty()) {
      tree = static_cast<int>(heads_.size());
      heads_.push_back(-1);
      births_.push_back(0);
    } else {
      tree = unused_.back();
      unused_.pop_back();
    }
    births_[tree] = ++last_birth_;
    return tree;
  }

  void add(int tree, int container) {
    const int head = heads_[tree];
    if (head >= 0 && blocks_[head].count < kPerBlock) {
      blocks_[head].item[blocks_[head].count++] = container;
      return;
    }
    int block = first_unused_;
    if (block >= 0) {
      first_unused_ = blocks_[block].next;
    } else {
      block = static_cast<int>(blocks_.size());
      blocks_.emplace_back();
    }
    blocks_[block].next = head;
    blocks_[block].count = 1;
    blocks_[block].item[0] = container;
    heads_[tree] = block;
  }

  void collect(int tree, std::vector<int>& containers) const {
    containers.clear();
    for (int b = heads_[tree]; b >= 0; b = blocks_[b].next) {
      containers.insert(containers.end(), blocks_[b].item, blocks_[b].item + blocks_[b].count);
    }
  }

  void drop(int tree) {
    for (int b = heads_[tree]; b >= 0;) {
      const int next = blocks_[b].next;
      blocks_[b].next = first_unused_;
      first_unused_ = b;
      b = next;
    }
    heads_[tree] = -1;
    births_[tree] = 0;
    unused_.push_back(tree);
  }

  /// Returns a number that tells a tree from an earlier one of the same index; 0: it does not exist.
  long long birth(int tree) const { return births_[tree]; }

 private:
  static constexpr int kPerBlock = 14;
  struct Block {
    int next, count;
    int item[kPerBlock];
  };
  std::vector<int> heads_, unused_;
  std::vector<long long> births_;
  long long last_birth_ = 0;
  std::vector<Block> blocks_;
  int first_unused_ = -1;
};

enum class SearchOutcome {
  kDone,
  kStuck,     ///< some trees can neither grow nor end, so there is no perfect matching
  kOverflow,  ///< times exceed the range of the numbers
};

/// A node with neighbors outside its range, and the upper limit of its total. Two ranges share the slack of
/// an edge between them equally.
template <class Value>
struct BorderNode {
  int node;
  Value cap;
};

/// Consecutive nodes that one search handles.
template <class Value>
struct SearchRange {
  int begin = 0, end = 0;
  /// A node in each container to start from, ascending. The search replaces them by a node in each free
  /// container.
  std::vector<int> roots = {};
  std::span<const BorderNode<Value>> border = {};  ///< ascending
  SearchOutcome outcome = SearchOutcome::kDone;
  Value time = 0;                 ///< end of the search
  std::vector<int> witness = {};  ///< proof if the search is stuck
  long long contractions = 0, expansions = 0;
};

/// Search by trees of alternating paths that grow from all free containers of a range at once, at equal
/// speed. A tree ends at another tree or a free container, and both are matched. It also ends at an odd cycle
/// that stays as a free blossom (`park`), and at the border of the range. docs/matching.md explains the
/// method.
///
/// Searches of disjoint ranges may run at once. Each changes only containers in its range, and reads others
/// only if none changes them.
template <class Value, class Cost>
class PrimalDualSearch {
 public:
  explicit PrimalDualSearch(PrimalDualState<Value, Cost>& state) : s_(state) {}

  /// Searches `range` and stores the result there. Times stay below `limit`. Roots whose totals agree modulo
  /// `modulus` keep all times integral.
  void run(SearchRange<Value>& range, Value limit, bool park, int modulus);

 private:
  using State = PrimalDualState<Value, Cost>;
  using Node = typename State::Node;
  using Child = typename State::Child;
  using Event = typename RadixQueue<Value>::Event;
  struct Step {
    int container, end, next;  ///< on a path to the root, with the edge to the next container
  };
  static constexpr std::size_t kFetchAhead = 12;  ///< entries of a list to prefetch
  static constexpr int kMarksAtOnce = 1024;
  static constexpr int kStart = -1, kVanish = -2, kBorder = -3;  ///< in place of an arc

  bool in_range(int v) const { return v >= range_->begin && v < range_->end; }
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

  /// Prefetches a node, which has two cache lines.
  void fetch(int v) const {
    __builtin_prefetch(&s_.nodes[v]);
    __builtin_prefetch(&s_.nodes[v].own_arcs);
  }
  void handle(const Event& event);
  void start(int v);
  Value room(int v) const;
  void reach_border(int v);
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
  void leave_free_ones();
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
  SearchRange<Value>* range_ = nullptr;
  RadixQueue<Value> queue_;
  TreeMembers members_;
  Value time_ = 0;
  bool park_ = false;
  int waiting_ = 0;                                 ///< roots that have not started
  int growing_ = 0;                                 ///< growing trees
  unsigned events_ = 0;                             ///< number of events, modulo 2^32
  std::vector<std::pair<int, long long>> stopped_;  ///< trees with their births
  std::vector<int> released_, missed_, loose_, parked_;
  std::vector<Step> path_a_, path_b_;
  std::vector<std::pair<int, int>> were_odd_;  ///< first and last nodes of lists
  int mark_ = 0, last_mark_ = 0;               ///< range of this search's marks
};

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::run(SearchRange<Value>& range, Value limit, bool park, int modulus) {
  range_ = &range;
  park_ = park;
  time_ = 0;
  queue_.reset();
  waiting_ = growing_ = 0;
  parked_.clear();
  for (const int v : range.roots) {
    const int c = s_.nodes[v].container;
    if (s_.matched(c) || !s_.inside(c, range.begin, range.end)) continue;
    const Value remainder = total(v) % modulus;
    queue_.push(remainder < 0 ? remainder + modulus : remainder, v, kStart);
    ++waiting_;
  }
  Event event;
  while (growing_ + waiting_ > 0) {
    if (++events_ % kPerCheck == 0) check_cancelled();
    if (!queue_.pop(event)) {
      find_witness();
      return;
    }
    time_ = event.time;
    if (time_ > limit) {
      range.outcome = SearchOutcome::kOverflow;
      return;
    }
    handle(event);
  }
  release_all();
  leave_free_ones();
  range.time = time_;
}

template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::handle(const Event& event) {
  if (event.arc >= 0) return follow(event.node, event.arc);
  if (event.arc == kStart) return start(event.node);
  if (event.arc == kBorder) return reach_border(event.node);
  const Node& node = s_.nodes[event.node];
  if (node.container == event.node && node.rate < 0 && node.blossom >= 0 && dual(event.node) == 0) {
    expand_odd(event.node);
  }
}

/// Returns the possible rise of the total of a node at the border.
template <class Value, class Cost>
Value PrimalDualSearch<Value, Cost>::room(int v) const {
  const auto at = std::ranges::lower_bound(range_->border, v, {}, &BorderNode<Value>::node);
  return at->cap - total(v);
}

/// Stops the tree of a node at the border whose total has reached its limit.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::reach_border(int v) {
  const Node& node = s_.nodes[s_.nodes[v].container];
  if (node.rate <= 0) return;
  const Value left = room(v);
  if (left > 0) return queue_.push(time_ + left, v, kBorder);
  stop(node.tree);
}

/// Starts a tree at a root, unless its container was matched meanwhile.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::start(int v) {
  --waiting_;
  const int c = s_.nodes[v].container;
  if (s_.matched(c)) return;
  ++growing_;
  join(c, 1, members_.make());
  scan_all(c);
}

/// Pushes events for the edges of a node that became even.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::scan(int v) {
  const Value mine = total(v);
  const int c = s_.nodes[v].container, tree = s_.nodes[c].tree;
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  const int degree = s_.nodes[v].degree;
  bool border = false;
  for (int a = 0; a < degree; ++a) {
    const int w = arcs[a].to;
    if (!in_range(w)) {
      border = true;
      continue;
    }
    const int d = s_.nodes[w].container;
    if (d == c) continue;
    Node& other = s_.nodes[d];
    if (other.rate < 0) {
      // A node in this tree stays odd as long as this one is even.
      if (other.tree != tree || other.blossom >= 0) other.missed = true;
      continue;
    }
    if (other.mate >= 0) fetch(other.mate);  // next place of growth
    const Value slack = arcs[a].cost - mine - (s_.nodes[w].value + offset(other));
    queue_.push(time_ + (other.rate > 0 ? slack / 2 : slack), v, a);
  }
  if (border) queue_.push(time_ + room(v), v, kBorder);
}

/// Pushes events for edges to even nodes, for a node that is no longer odd or no longer changes.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::scan_missed(int v) {
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  for (int a = 0; a < s_.nodes[v].degree; ++a) {
    const int w = arcs[a].to;
    if (in_range(w) && s_.nodes[s_.nodes[w].container].rate > 0) queue_.push(time_ + slack(v, arcs[a]), v, a);
  }
}

/// Handles an edge that may have become tight.
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
  } else if (other.label < 0) {
    stop(mine.tree);
  } else {
    meet(v, w);
  }
}

}  // namespace delquad
