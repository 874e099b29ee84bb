// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

#include "base/cancel.h"

namespace delquad {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// Units of the matching for the longest path, fine enough to distinguish relevant paths.
constexpr double kUnits = 1e9;

struct Paths {
  std::vector<double> distance;
  std::vector<int> edge;  ///< edge to each node; -1 at the source
};

Paths shortest_paths(const WeightedGraph& graph, const std::vector<std::vector<int>>& incident, int source) {
  check_cancelled();
  Paths paths{std::vector<double>(graph.n_nodes, kFar), std::vector<int>(graph.n_nodes, -1)};
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
  paths.distance[source] = 0;
  queue.push({0, source});
  while (!queue.empty()) {
    const auto [d, node] = queue.top();
    queue.pop();
    if (d > paths.distance[node]) continue;
    for (const int e : incident[node]) {
      const auto& edge = graph.edges[e];
      const int other = edge.a == node ? edge.b : edge.a;
      if (d + edge.cost < paths.distance[other]) {
        paths.distance[other] = d + edge.cost;
        paths.edge[other] = e;
        queue.push({paths.distance[other], other});
      }
    }
  }
  return paths;
}

/// Removes one terminal from each component with an odd number of them. Returns these.
std::vector<int> leave_odd_ones(std::vector<int>& terminals, std::vector<Paths>& paths) {
  std::vector<int> left;
  for (size_t i = terminals.size(); i-- > 0;) {
    const auto reached = [&](int t) { return paths[i].distance[t] < kFar; };
    const bool last = std::none_of(terminals.begin() + i + 1, terminals.end(), reached);
    if (!last || std::count_if(terminals.begin(), terminals.end(), reached) % 2 == 0) continue;
    left.push_back(terminals[i]);
    terminals.erase(terminals.begin() + i);
    paths.erase(paths.begin() + i);
  }
  return left;
}

}  // namespace

TJoin minimum_t_join(const WeightedGraph& graph, const std::vector<int>& terminals,
                     const MatchingSolver& solver) {
  assert(std::ranges::all_of(graph.edges, [](const auto& e) { return e.cost >= 0; }));
  assert(std::set<int>(terminals.begin(), terminals.end()).size() == terminals.size());
  std::vector<std::vector<int>> incident(graph.n_nodes);
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    incident[graph.edges[e].a].push_back(static_cast<int>(e));
    incident[graph.edges[e].b].push_back(static_cast<int>(e));
  }
  std::vector<int> ends = terminals;
  std::vector<Paths> paths;
  for (const int t : ends) paths.push_back(shortest_paths(graph, incident, t));
  TJoin join;
  join.unmatched = leave_odd_ones(ends, paths);
  if (ends.empty()) return join;

  double longest = 0;
  for (const auto& p : paths) {
    for (const int t : ends) {
      if (p.distance[t] < kFar) longest = std::max(longest, p.distance[t]);
    }
  }
  const double scale = longest > 0 ? kUnits / longest : 1;
  MatchingGraph complete{static_cast<int>(ends.size()), {}};
  for (int i = 0; i < complete.n_nodes; ++i) {
    for (int j = i + 1; j < complete.n_nodes; ++j) {
      const double d = paths[i].distance[ends[j]];
      if (d < kFar) complete.edges.push_back({i, j, std::llround(d * scale)});
    }
  }
  const MatchingResult matching = solver.solve(complete);
  std::vector<char> odd(graph.edges.size(), 0);
  for (int i = 0; i < complete.n_nodes; ++i) {
    if (matching.mate[i] < i) continue;
    for (int node = ends[matching.mate[i]]; paths[i].edge[node] >= 0;) {
      const int e = paths[i].edge[node];
      odd[e] ^= 1;
      node = graph.edges[e].a == node ? graph.edges[e].b : graph.edges[e].a;
    }
  }
  for (size_t e = 0; e < odd.size(); ++e) {
    if (odd[e]) join.edges.push_back(static_cast<int>(e));
  }
  return join;
}

}  // namespace delquad
