#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/matching/primal_dual_blossoms.h"
#include "base/matching/primal_dual_search.h"
#include "base/matching/primal_dual_state.h"
#include "base/matching/primal_dual_trees.h"
#include "base/parallel.h"
#include "base/parallel_collect.h"

namespace delquad {

/// Searches ranges of nodes, those of one level at once, each time in larger ones. The ranges do not depend
/// on the number of threads, and no search sees what another one of its level does: nor does the result.
template <class Value, class Cost>
class PrimalDualLevels {
 public:
  PrimalDualLevels(PrimalDualState<Value, Cost>& state, Value time_limit) : s_(state), limit_(time_limit) {
    note_border();
  }

  /// Goes through all levels; `park` and `modulus` as for PrimalDualSearch.
  SearchOutcome run(bool park, int modulus);

  std::vector<int> witness;  ///< where a search found that there is no perfect matching
  long long contractions = 0, expansions = 0;

 private:
  using Search = PrimalDualSearch<Value, Cost>;
  using Border = BorderNode<Value>;

  /// Nodes of the smallest ranges: their part of the graph stays in a fast cache.
  static constexpr int kFirstRange = 4096;
  /// Ranges of one level that make one of the next.
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
  std::vector<int> border_;  ///< nodes with neighbours outside their smallest range
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

template <class Value, class Cost>
bool PrimalDualLevels<Value, Cost>::has_arc_out(int v, long long range) const {
  const auto* const arcs = s_.arcs_of(s_.nodes[v]);
  const long long begin = v / range * range;
  return std::any_of(arcs, arcs + s_.nodes[v].degree,
                     [&](const auto& arc) { return arc.to < begin || arc.to >= begin + range; });
}

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
