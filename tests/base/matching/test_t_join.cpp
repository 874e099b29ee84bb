// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

std::vector<int> odd_nodes(const WeightedGraph& graph, const std::vector<int>& edges) {
  std::vector<int> degree(graph.n_nodes, 0), odd;
  for (const int e : edges) ++degree[graph.edges[e].a], ++degree[graph.edges[e].b];
  for (int i = 0; i < graph.n_nodes; ++i) {
    if (degree[i] % 2) odd.push_back(i);
  }
  return odd;
}

double cost(const WeightedGraph& graph, const std::vector<int>& edges) {
  double sum = 0;
  for (const int e : edges) sum += graph.edges[e].cost;
  return sum;
}

TEST(TJoin, CheapestOfAllSubsetsOnRandomGraphs) {
  std::mt19937_64 random(1);
  int solvable = 0;
  for (int trial = 0; trial < 300; ++trial) {
    WeightedGraph graph{3 + static_cast<int>(random() % 5), {}};
    const int n_edges = static_cast<int>(random() % 11);
    for (int e = 0; e < n_edges; ++e) {  // loops and parallel edges happen
      graph.edges.push_back({static_cast<int>(random() % graph.n_nodes),
                             static_cast<int>(random() % graph.n_nodes), shapes::uniform(random)});
    }
    std::vector<int> terminals;
    for (int i = 0; i < graph.n_nodes; ++i) {
      if (random() % 2) terminals.push_back(i);
    }
    double best = INFINITY;
    for (int set = 0; set < 1 << n_edges; ++set) {
      std::vector<int> edges;
      for (int e = 0; e < n_edges; ++e) {
        if (set >> e & 1) edges.push_back(e);
      }
      if (odd_nodes(graph, edges) == terminals) best = std::min(best, cost(graph, edges));
    }
    const TJoin join = minimum_t_join(graph, terminals, *make_primal_dual_solver());
    EXPECT_EQ(join.unmatched.empty(), best < INFINITY) << trial;
    if (best == INFINITY) continue;
    ++solvable;
    EXPECT_EQ(odd_nodes(graph, join.edges), terminals) << trial;
    EXPECT_NEAR(cost(graph, join.edges), best, 1e-8) << trial;
  }
  EXPECT_GT(solvable, 50);
}

TEST(TJoin, LeavesOneTerminalOfAnOddComponent) {
  const WeightedGraph path{5, {{0, 1, 1}, {1, 2, 1}}};
  const TJoin join = minimum_t_join(path, {0, 1, 2, 4}, *make_primal_dual_solver());
  EXPECT_EQ(join.unmatched.size(), 2u);
  EXPECT_EQ(join.edges.size(), 1u);
}

}  // namespace
}  // namespace delquad
