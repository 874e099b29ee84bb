// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/even_counts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>

#include "base/disjoint_sets.h"

namespace delquad {

namespace {

/// Factor for the cost of curves of one or two edges, whose sizes change most.
constexpr double kFewEdgesPenalty = 4;
/// Cost if edges become shorter than the limits.
constexpr double kTooShortPenalty = 10;

/// Vector of numbers mod 2, by the places of its ones.
using Parities = std::set<int>;

void add(Parities& to, const Parities& other) {
  for (const int i : other)
    if (const auto [at, added] = to.insert(i); !added) to.erase(at);
}

/// Returns the patches whose parity changes if a curve at these patches changes by one.
std::vector<int> with_other_parity(std::vector<int> patches) {
  if (patches.size() == 2 && patches[0] != patches[1]) return patches;
  Parities odd;
  for (const int p : patches) add(odd, {p});
  return {odd.begin(), odd.end()};
}

/// Returns the component of each node.
std::vector<int> components(const WeightedGraph& graph) {
  DisjointSets parts(graph.n_nodes);
  for (const auto& e : graph.edges) parts.join_to(e.b, e.a);
  return parts.roots();
}

/// Returns the curves of more than two patches (indices into `costs`) to change. Then each component of the
/// graph has an even number of odd patches, if possible. Such a curve is no edge of the graph; it changes the
/// parity of several components, its column. The sum of columns mod 2 is found by elimination, cheap columns
/// first.
std::vector<int> columns_for(const std::vector<Parities>& columns, const std::vector<double>& costs,
                             Parities wanted) {
  struct Row {
    Parities column, made_of;
  };
  std::map<int, Row> basis;  // by the first place of the column
  const auto reduce = [&](Row& row) {
    while (!row.column.empty()) {
      const auto at = basis.find(*row.column.begin());
      if (at == basis.end()) return;
      add(row.column, at->second.column);
      add(row.made_of, at->second.made_of);
    }
  };
  std::vector<int> order(columns.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int c) { return costs[c]; });
  for (const int c : order) {
    Row row{columns[c], {c}};
    reduce(row);
    if (!row.column.empty()) basis.emplace(*row.column.begin(), row);
  }
  Row sum{std::move(wanted), {}};
  Parities chosen;
  while (!sum.column.empty()) {  // a component in no column stays odd
    const auto at = basis.find(*sum.column.begin());
    if (at == basis.end()) {
      sum.column.erase(sum.column.begin());
      continue;
    }
    add(sum.column, at->second.column);
    add(chosen, at->second.made_of);
  }
  return {chosen.begin(), chosen.end()};
}

/// Changes curves of more than two patches, so that the T-join can do the rest.
void even_branches(const std::vector<CurveDemand>& curves, const std::vector<int>& branching,
                   const WeightedGraph& graph, ChangeCost cost, std::vector<int>& counts,
                   std::vector<int>& total) {
  if (branching.empty()) return;
  const std::vector<int> part = components(graph);
  const int free_part = part.back();  // component of the outside
  const auto parity = [&](const std::vector<int>& patches) {
    Parities odd;
    for (const int p : patches)
      if (part[p] != free_part) add(odd, {part[p]});
    return odd;
  };
  std::vector<int> odd_patches;
  for (size_t p = 0; p < total.size(); ++p)
    if (total[p] % 2) odd_patches.push_back(static_cast<int>(p));
  std::vector<Parities> columns;
  std::vector<double> costs;
  for (const int c : branching) {
    columns.push_back(parity(curves[c].patches));
    costs.push_back(cost(counts[c], curves[c]));
  }
  for (const int i : columns_for(columns, costs, parity(odd_patches))) {
    const int c = branching[i], n = changed_by_one(counts[c], curves[c]);
    for (const int p : curves[c].patches) total[p] += n - counts[c];
    counts[c] = n;
  }
}

}  // namespace

int changed_by_one(int n, const CurveDemand& curve) {
  assert(n >= 1);
  if (n - 1 < curve.minimum) return n + 1;
  if (n + 1 > curve.most) return n - 1;
  const auto misfit = [&](int m) { return std::abs(std::log(m / std::max(curve.integral, 1e-3))); };
  return misfit(n - 1) < misfit(n + 1) ? n - 1 : n + 1;
}

double cost_of_change(int n, const CurveDemand& curve) {
  const double change = std::abs(std::log(changed_by_one(n, curve) / static_cast<double>(n)));
  return change * (n <= 2 ? kFewEdgesPenalty : 1);
}

std::vector<int> even_counts(const std::vector<CurveDemand>& curves, int n_patches,
                             const MatchingSolver& solver, std::vector<int>& odd_patches, ChangeCost cost) {
  assert(std::ranges::all_of(curves, [&](const CurveDemand& curve) {
    return std::isfinite(curve.integral) && curve.minimum >= 1 &&
           std::ranges::all_of(curve.patches, [&](int p) { return p >= 0 && p < n_patches; });
  }));
  std::vector<int> counts;
  std::vector<int> total(n_patches, 0);
  WeightedGraph graph{n_patches + 1, {}};  // the last node is the outside
  std::vector<int> curve_of_edge, branching;
  for (size_t c = 0; c < curves.size(); ++c) {
    const CurveDemand& curve = curves[c];
    const int n =
        curve.exact > 0
            ? curve.exact
            : std::max(curve.minimum, std::min(curve.most, static_cast<int>(std::lround(curve.integral))));
    counts.push_back(n);
    for (const int p : curve.patches) total[p] += n;
    if (curve.exact > 0) continue;
    const std::vector<int> patches = with_other_parity(curve.patches);
    if (patches.size() > 2) branching.push_back(static_cast<int>(c));
    if (patches.empty() || patches.size() > 2) continue;
    const int a = patches[0], b = patches.size() == 2 ? patches[1] : n_patches;
    const double too_short = changed_by_one(n, curve) > curve.most ? kTooShortPenalty : 0;
    graph.edges.push_back({a, b, cost(n, curve) + too_short});
    curve_of_edge.push_back(static_cast<int>(c));
  }
  even_branches(curves, branching, graph, cost, counts, total);
  std::vector<int> terminals;
  for (int p = 0; p < n_patches; ++p) {
    if (total[p] % 2) terminals.push_back(p);
  }
  // The outside takes part where its component has an odd number of odd patches.
  TJoin join = minimum_t_join(graph, terminals, solver);
  if (!join.unmatched.empty()) {
    std::vector<int> with_outside = terminals;
    with_outside.push_back(n_patches);
    const TJoin other = minimum_t_join(graph, with_outside, solver);
    if (std::count_if(other.unmatched.begin(), other.unmatched.end(), [&](int t) { return t < n_patches; }) <
        static_cast<long>(join.unmatched.size())) {
      join = other;
    }
  }
  for (const int e : join.edges) {
    const int c = curve_of_edge[e];
    counts[c] = changed_by_one(counts[c], curves[c]);
  }
  odd_patches.clear();
  for (const int t : join.unmatched) {
    if (t < n_patches) odd_patches.push_back(t);
  }
  std::sort(odd_patches.begin(), odd_patches.end());
  return counts;
}

}  // namespace delquad
