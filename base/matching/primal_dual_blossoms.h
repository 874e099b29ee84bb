#pragma once

#include <utility>
#include <vector>

#include "base/matching/primal_dual_search.h"

/// The part of the search that makes and opens blossoms.
namespace delquad {

/// The edge between v and w, both even and in one tree, is tight: it closes an odd cycle.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::contract(int v, int w) {
  ++range_->contractions;
  const int common = common_container(s_.nodes[v].container, s_.nodes[w].container);
  const int base = s_.nodes[common].base, tree = s_.nodes[common].tree;
  const int b = s_.blossoms.make();
  list_children(v, w, common, s_.blossoms[b].children);
  join_lists(b);

  // The blossom goes by the name of its largest part, whose nodes need not be told.
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

/// The tree ends here, and its new blossom is free.
template <class Value, class Cost>
void PrimalDualSearch<Value, Cost>::park_cycle(int container) {
  free_base(container);
  parked_.push_back(s_.nodes[container].base);
  --growing_;
  dissolve(s_.nodes[container].tree);
  settle();
}

/// The first even container that the paths from a and b to their root share.
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

/// The containers from an even one up to, and without, another, each with the edge to the next.
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

/// The cycle: from the common container down to v, over to w, and up again.
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

/// Puts the lists of the children's nodes together, and keeps the children's dual values.
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

/// Brings the nodes of all children to one container, that of one of them. Their totals stay.
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

/// The dual value of an odd blossom is zero: the part of its cycle that keeps the tree together stays in the
/// tree.
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
  // Towards the base by an even number of links.
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

}  // namespace delquad
