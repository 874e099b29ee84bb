// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "delquad/matching.h"

/// Random graphs of many kinds, to try matching solvers on.
namespace delquad::testing_support {

using Random = std::mt19937_64;

inline int below(Random& random, int n) { return static_cast<int>(random() % n); }

/// Costs from 0 to `largest`; with few values ties abound.
inline void price(MatchingGraph& graph, Random& random, long long largest) {
  for (auto& e : graph.edges) e.cost = static_cast<long long>(random() % (largest + 1));
}

inline MatchingGraph sparse_graph(Random& random, int n, double mean_degree) {
  MatchingGraph graph{n, {}};
  const int m = static_cast<int>(n * mean_degree / 2);
  for (int i = 0; i < m; ++i) {
    const int a = below(random, n), b = below(random, n);
    if (a != b) graph.edges.push_back({a, b, 0});
  }
  return graph;
}

inline MatchingGraph complete_graph(int n) {
  MatchingGraph graph{n, {}};
  for (int b = 0; b < n; ++b) {
    for (int a = 0; a < b; ++a) graph.edges.push_back({a, b, 0});
  }
  return graph;
}

/// Odd cycles, hanging together by single edges: bridges, which blossoms are made and opened around.
inline MatchingGraph linked_cycles(Random& random, int n_cycles) {
  MatchingGraph graph;
  std::vector<int> first, length;
  for (int c = 0; c < n_cycles; ++c) {
    first.push_back(graph.n_nodes);
    length.push_back(3 + 2 * below(random, 3));
    for (int i = 0; i < length[c]; ++i) {
      graph.edges.push_back({first[c] + i, first[c] + (i + 1) % length[c], 0});
    }
    graph.n_nodes += length[c];
  }
  const auto any_of = [&](int c) { return first[c] + below(random, length[c]); };
  for (int c = 1; c < n_cycles; ++c) graph.edges.push_back({any_of(c), any_of(below(random, c)), 0});
  for (int k = 0; k < n_cycles; ++k) {
    const int a = below(random, n_cycles), b = below(random, n_cycles);
    if (a != b) graph.edges.push_back({any_of(a), any_of(b), 0});
  }
  return graph;
}

/// Every node has three neighbors or fewer, some of them twice: two paths side by side between the same
/// nodes.
inline MatchingGraph cubic_graph(Random& random, int n) {
  MatchingGraph graph{n, {}};
  for (int round = 0; round < 3; ++round) {
    std::vector<int> nodes(n);
    for (int v = 0; v < n; ++v) nodes[v] = v;
    std::shuffle(nodes.begin(), nodes.end(), random);
    // Pairs near each other, so that cycles are short.
    for (int v = 0; v + 1 < n; v += 2) {
      const int a = round == 0 ? v : nodes[v], b = round == 0 ? v + 1 : nodes[v + 1];
      graph.edges.push_back({a, b, 0});
    }
  }
  return graph;
}

/// The triangles of a triangular lattice of k rows. k more of them point up than down. The ends of the fan of
/// each corner on the rim have an edge that is dearer than all others.
inline MatchingGraph triangle_lattice(int k, long long cost, long long rim_cost) {
  MatchingGraph graph;
  std::vector<int> row(k + 1, 0);  // number of the first triangle
  for (int j = 0; j < k; ++j) row[j + 1] = row[j] + 2 * (k - j) - 1;
  graph.n_nodes = row[k];
  const auto up = [&](int i, int j) { return row[j] + 2 * i; };
  for (int j = 0; j < k; ++j) {
    for (int i = 0; i + j + 1 < k; ++i) {
      const int down = up(i, j) + 1;
      graph.edges.push_back({up(i, j), down, cost});
      graph.edges.push_back({down, up(i + 1, j), cost});
      graph.edges.push_back({down, up(i, j + 1), cost});
    }
  }
  for (int i = 0; i + 1 < k; ++i) {
    graph.edges.push_back({up(i, 0), up(i + 1, 0), rim_cost});
    graph.edges.push_back({up(0, i), up(0, i + 1), rim_cost});
    graph.edges.push_back({up(k - 1 - i, i), up(k - 2 - i, i + 1), rim_cost});
  }
  return graph;
}

}  // namespace delquad::testing_support
