#pragma once

#include <vector>

#include "base/matching/matching.h"

namespace delquad {

/// A graph with costs >= 0 on its edges; parallel edges and self-loops are allowed.
struct WeightedGraph {
  struct Edge {
    int a, b;
    double cost;
  };
  int n_nodes = 0;
  std::vector<Edge> edges;
};

struct TJoin {
  std::vector<int> edges;      ///< chosen, ascending
  std::vector<int> unmatched;  ///< a terminal of each component that has an odd number of them; left as it is
};

/// The cheapest set of edges in which exactly the terminals have odd degree [edmonds1973]: shortest paths
/// between terminals, matched at minimum cost. `terminals` are distinct nodes.
TJoin minimum_t_join(const WeightedGraph& graph, const std::vector<int>& terminals,
                     const MatchingSolver& solver);

}  // namespace delquad
