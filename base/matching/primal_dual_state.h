// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "base/system.h"

// This header has the state of the primal-dual method. Its searches share it.

namespace delquad {

/// Pool of numbered items that several threads make and drop at once. An item keeps its place and belongs to
/// its maker; dropped items are reused. Numbers depend on threads, so nothing else may depend on them.
template <class Item>
class SharedPool {
 public:
  /// At most `most` items live at any time.
  explicit SharedPool(std::size_t most) : chunks_(most / kChunk + 1) {}

  Item& operator[](int i) { return chunks_[static_cast<std::size_t>(i) / kChunk][i % kChunk]; }
  const Item& operator[](int i) const { return chunks_[static_cast<std::size_t>(i) / kChunk][i % kChunk]; }

  int make() {
    const std::lock_guard lock(mutex_);
    if (!unused_.empty()) {
      const int i = unused_.back();
      unused_.pop_back();
      return i;
    }
    auto& chunk = chunks_[static_cast<std::size_t>(made_) / kChunk];
    if (!chunk) chunk = std::make_unique<Item[]>(kChunk);
    return made_++;
  }

  void drop(int i) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(i);
  }

 private:
  static constexpr int kChunk = 1024;
  std::vector<std::unique_ptr<Item[]>> chunks_;
  std::vector<int> unused_;
  int made_ = 0;
  std::mutex mutex_;
};

/// Allocates large arrays with random access on pages of two megabytes, if the system has them. Finding a
/// small page in memory costs about as much as reading from it.
template <class Item>
struct HugePageAllocator {
  using value_type = Item;

  HugePageAllocator() = default;
  template <class Other>
  HugePageAllocator(const HugePageAllocator<Other>&) {}

  Item* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / sizeof(Item)) throw std::bad_array_new_length();
    const std::size_t size = n * sizeof(Item);
    void* const items = ::operator new(size, alignment(size));
    if (size >= kHugePage) use_huge_pages(items, size);
    return static_cast<Item*>(items);
  }
  void deallocate(Item* items, std::size_t n) { ::operator delete(items, alignment(n * sizeof(Item))); }
  template <class Other>
  bool operator==(const HugePageAllocator<Other>&) const {
    return true;
  }

 private:
  static std::align_val_t alignment(std::size_t size) {
    return std::align_val_t{size >= kHugePage ? kHugePage : alignof(Item)};
  }
};

/// Nodes or events between checks for cancellation: some milliseconds of work.
inline constexpr unsigned kPerCheck = 1u << 14;

/// State of the primal-dual method between two searches (docs/matching.md): a matching, dual values and
/// blossoms. No edge has negative slack, and matched edges and links of blossoms have slack 0.
///
/// A container is a node outside all blossoms, or an outermost blossom; its number is one of its nodes. The
/// total of a node sums up its dual value and those around it: its `value` plus the `offset` of its
/// container. The slack of an edge between two containers is its cost minus the totals of its ends.
template <class Value, class Cost>
struct PrimalDualState {
  struct Arc {
    Cost cost;  ///< in quarters
    int to;
  };

  /// Nodes with more arcs store them apart.
  static constexpr int kOwnArcs = 3;

  struct alignas(32) Node {
    Value value = 0;
    int container = 0;
    int mate = -1;  ///< valid for nodes by which a container is matched
    // Fields of the container with this node's number:
    Value offset = 0;
    int tree = -1;               ///< tree of the container
    int blossom = -1;            ///< its outermost blossom; -1: a node
    int base = -1;               ///< node by which it is matched, or at which it is free
    int outer = -1, inner = -1;  ///< edge by which it joined its tree as an odd container
    int mark = 0;
    signed char label = 0;  ///< 1 even, -1 odd, 0 in no tree
    signed char rate = 0;   ///< growth of the offset with time: the label, or 0 in a stopped tree
    bool missed = false;    ///< an event with an even neighbor was dropped since it is odd
    int degree = 0;
    Arc own_arcs[kOwnArcs];  ///< or, in `to` of the first one, the index of its first arc
  };

  struct Child {
    int blossom;    ///< -1: a node
    int container;  ///< its container before the contraction
    int end, next;  ///< ends of the edge to the next child, here and there
  };

  struct Blossom {
    int first = -1, last = -1, size = 0;  ///< list of its nodes
    int lowest = 0, highest = 0;          ///< range of its nodes
    Value dual = 0;                       ///< while it is inside another blossom
    Value origin = 0;             ///< while it is outermost: the offset at which its dual value is zero
    std::vector<Child> children;  ///< around the odd cycle
  };

  explicit PrimalDualState(int n) : n_nodes(n), nodes(n), next(n), blossoms(n / 2) {}

  int n_nodes;
  int hub = 0;  ///< nodes with more arcs are hubs, only in the range of all nodes
  std::vector<Node, HugePageAllocator<Node>> nodes;
  std::vector<int> next;  ///< in the node lists of blossoms
  std::vector<Arc> arcs;  ///< of nodes with many arcs
  SharedPool<Blossom> blossoms;
  /// Next mark; searches take several at a time, and each is used once.
  std::atomic<int> marks = 0;
  std::vector<int> free_nodes;  ///< one in each unmatched container

  const Arc* arcs_of(const Node& node) const {
    return node.degree <= kOwnArcs ? node.own_arcs : arcs.data() + node.own_arcs[0].to;
  }

  bool matched(int container) const { return nodes[nodes[container].base].mate >= 0; }

  /// Matches two nodes, and their containers by them.
  void match(int a, int b) {
    nodes[nodes[a].container].base = a;
    nodes[nodes[b].container].base = b;
    nodes[a].mate = b;
    nodes[b].mate = a;
  }

  int first_node(const Child& child) const {
    return child.blossom < 0 ? child.container : blossoms[child.blossom].first;
  }
  int last_node(const Child& child) const {
    return child.blossom < 0 ? child.container : blossoms[child.blossom].last;
  }

  template <class F>
  void each_in_list(int first, int last, F f) const {
    for (int v = first;; v = next[v]) {
      f(v);
      if (v == last) return;
    }
  }
  template <class F>
  void each_node(int container, F f) const {
    const int b = nodes[container].blossom;
    if (b < 0) return f(container);
    each_in_list(blossoms[b].first, blossoms[b].last, f);
  }

  /// Returns the total of a node, which is valid while no search runs.
  Value total(int v) const { return nodes[v].value + nodes[nodes[v].container].offset; }

  /// Returns whether all nodes of a container are in a range; hubs are in the range of all nodes only.
  bool inside(int container, int begin, int end) const {
    const int b = nodes[container].blossom;
    if (b >= 0) return blossoms[b].lowest >= begin && blossoms[b].highest < end;
    return nodes[container].degree <= hub || end - begin == n_nodes;
  }
  /// Returns whether a search of the range may change a container, and so its matched one.
  bool movable(int container, int begin, int end) const {
    if (!inside(container, begin, end)) return false;
    const int mate = nodes[nodes[container].base].mate;
    return mate < 0 || (mate >= begin && mate < end && inside(nodes[mate].container, begin, end));
  }

  /// Replaces the outermost blossom of a container by its children, matched around the cycle and in no tree.
  /// `offset` is the current one of the container.
  std::vector<Child> expand(int container, Value offset) {
    const int b = nodes[container].blossom, base = nodes[container].base;
    std::vector<Child> children;
    children.swap(blossoms[b].children);
    blossoms.drop(b);
    for (const Child& child : children) {
      const int c = child.container;
      if (c != container)
        each_in_list(first_node(child), last_node(child), [&](int v) { nodes[v].container = c; });
      Node& node = nodes[c];
      node.offset = offset;
      node.blossom = child.blossom;
      node.tree = -1;
      node.label = node.rate = 0;
      node.missed = false;
      if (child.blossom >= 0) blossoms[child.blossom].origin = offset - blossoms[child.blossom].dual;
    }
    const int k = static_cast<int>(children.size()), start = index_of(children, nodes[base].container);
    nodes[children[start].container].base = base;
    for (int i = 1; i < k; i += 2) {
      const Child& child = children[(start + i) % k];
      match(child.end, child.next);
    }
    return children;
  }

  static int index_of(const std::vector<Child>& children, int container) {
    int i = 0;
    while (children[i].container != container) ++i;
    return i;
  }
};

}  // namespace delquad
