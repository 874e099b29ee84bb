#include "algorithms/recombination/dual_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/recombination/hilbert.h"
#include "algorithms/recombination/quad_cost.h"
#include "base/cancel.h"
#include "base/parallel.h"
#include "base/parallel_collect.h"
#include "mesh/tri_topology.h"

namespace delquad {

namespace {

std::vector<int> triangles_along_curve(const TriPatch& tri) {
  std::vector<Vec2> centroids(tri.triangles.size());
  parallel_ranges(centroids.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& v = tri.triangles[t];
      centroids[t] = (1.0 / 3) * (tri.points[v[0]] + tri.points[v[1]] + tri.points[v[2]]);
    }
  });
  return hilbert_order(centroids);
}

long long merge_cost(const TriPatch& tri, int t, int side, int u) {
  const auto& v = tri.triangles[t];
  const int opposite = tri.triangles[u][facing_side(tri, u, t)];
  const double eta = signed_eta(tri.points[v[side]], tri.points[v[(side + 1) % 3]], tri.points[opposite],
                                tri.points[v[(side + 2) % 3]]);
  return static_cast<long long>(std::floor(kCostUnit * (1 - eta)));
}

std::vector<MatchingGraph::Edge> interior_sides(const TriPatch& tri, const std::vector<int>& triangle,
                                                const std::vector<int>& node) {
  using Edges = std::vector<MatchingGraph::Edge>;
  return parallel_collect<MatchingGraph::Edge>(
      triangle.size(), [&](std::size_t begin, std::size_t end, Edges& edges) {
        edges.reserve(3 * (end - begin));
        for (std::size_t i = begin; i < end; ++i) {
          const int t = triangle[i];
          for (int side = 0; side < 3; ++side) {
            const int u = tri.neighbours[t][side];
            if (u < 0 || node[u] < static_cast<int>(i)) continue;
            edges.push_back({static_cast<int>(i), node[u], merge_cost(tri, t, side, u)});
          }
        }
      });
}

void add_extra_edges(const TriPatch& tri, const std::vector<int>& node, DualGraph& dual) {
  std::vector<int> first(tri.n_boundary, -1), last(tri.n_boundary, -1);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int side = 0; side < 3; ++side) {
      if (tri.neighbours[t][side] >= 0) continue;
      first[tri.triangles[t][(side + 1) % 3]] = static_cast<int>(t);
      last[tri.triangles[t][(side + 2) % 3]] = static_cast<int>(t);
    }
  }
  for (int b = 0; b < tri.n_boundary; ++b) {
    if (first[b] < 0 || first[b] == last[b] || facing_side(tri, first[b], last[b]) >= 0) continue;
    dual.graph.edges.push_back({node[first[b]], node[last[b]], kExtraEdgeCost});
    dual.extra_vertex.push_back(b);
  }
}

int first_node_of(std::vector<int>& before, int v) {
  while (before[v] != v) v = before[v] = before[before[v]];
  return v;
}

/// Components go by their first nodes.
void add_spares(DualGraph& dual) {
  const int n = dual.graph.n_nodes;
  std::vector<int> first(n), spare(n, 0);
  std::iota(first.begin(), first.end(), 0);
  for (int e = 0; e < dual.first_extra; ++e) {
    const int a = first_node_of(first, dual.graph.edges[e].a),
              b = first_node_of(first, dual.graph.edges[e].b);
    first[std::max(a, b)] = std::min(a, b);
  }
  for (int v = 0; v < n; ++v) spare[first[v] = first_node_of(first, v)] ^= 1;
  for (int v = 0; v < n; ++v) spare[v] = spare[v] != 0 ? dual.graph.n_nodes++ : -1;
  if (dual.graph.n_nodes == n) return;
  for (int v = 0; v < n; ++v) {
    if (spare[first[v]] >= 0) dual.graph.edges.push_back({v, spare[first[v]], 0});
  }
}

}  // namespace

DualGraph build_dual_graph(const TriPatch& tri) {
  DualGraph dual;
  dual.triangle = triangles_along_curve(tri);
  dual.graph.n_nodes = static_cast<int>(tri.triangles.size());
  std::vector<int> node(tri.triangles.size());
  for (std::size_t i = 0; i < dual.triangle.size(); ++i) node[dual.triangle[i]] = static_cast<int>(i);
  check_cancelled();
  dual.graph.edges = interior_sides(tri, dual.triangle, node);
  dual.first_extra = static_cast<int>(dual.graph.edges.size());
  add_extra_edges(tri, node, dual);
  check_cancelled();
  add_spares(dual);
  return dual;
}

}  // namespace delquad
