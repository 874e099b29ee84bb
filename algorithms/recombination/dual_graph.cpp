#include "algorithms/recombination/dual_graph.h"

#include <cmath>

#include "algorithms/recombination/hilbert.h"
#include "algorithms/recombination/quad_cost.h"
#include "mesh/tri_topology.h"

namespace delquad {

namespace {

std::vector<int> triangles_along_curve(const TriPatch& tri) {
  std::vector<Vec2> centroids(tri.triangles.size());
  for (std::size_t t = 0; t < centroids.size(); ++t) {
    const auto& v = tri.triangles[t];
    centroids[t] = (1.0 / 3) * (tri.points[v[0]] + tri.points[v[1]] + tri.points[v[2]]);
  }
  return hilbert_order(centroids);
}

long long merge_cost(const TriPatch& tri, int t, int side, int u) {
  const auto& v = tri.triangles[t];
  const int opposite = tri.triangles[u][facing_side(tri, u, t)];
  const double eta = signed_eta(tri.points[v[side]], tri.points[v[(side + 1) % 3]], tri.points[opposite],
                                tri.points[v[(side + 2) % 3]]);
  return static_cast<long long>(std::floor(kCostUnit * (1 - eta)));
}

void add_interior_sides(const TriPatch& tri, const std::vector<int>& node, DualGraph& dual) {
  dual.graph.edges.reserve(tri.triangles.size() * 3 / 2);
  for (std::size_t i = 0; i < dual.triangle.size(); ++i) {
    const int t = dual.triangle[i];
    for (int side = 0; side < 3; ++side) {
      const int u = tri.neighbours[t][side];
      if (u < 0 || node[u] < static_cast<int>(i)) continue;
      dual.graph.edges.push_back({static_cast<int>(i), node[u], merge_cost(tri, t, side, u)});
    }
  }
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

void add_spares(const TriPatch& tri, const std::vector<int>& node, DualGraph& dual) {
  std::vector<char> seen(tri.triangles.size(), 0);
  std::vector<int> component;
  for (const int start : dual.triangle) {
    if (seen[start] != 0) continue;
    component.assign(1, start);
    seen[start] = 1;
    for (std::size_t i = 0; i < component.size(); ++i) {
      for (const int u : tri.neighbours[component[i]]) {
        if (u < 0 || seen[u] != 0) continue;
        seen[u] = 1;
        component.push_back(u);
      }
    }
    if (component.size() % 2 == 0) continue;
    const int spare = dual.graph.n_nodes++;
    for (const int t : component) dual.graph.edges.push_back({node[t], spare, 0});
  }
}

}  // namespace

DualGraph build_dual_graph(const TriPatch& tri) {
  DualGraph dual;
  dual.triangle = triangles_along_curve(tri);
  dual.graph.n_nodes = static_cast<int>(tri.triangles.size());
  std::vector<int> node(tri.triangles.size());
  for (std::size_t i = 0; i < dual.triangle.size(); ++i) node[dual.triangle[i]] = static_cast<int>(i);
  add_interior_sides(tri, node, dual);
  dual.first_extra = static_cast<int>(dual.graph.edges.size());
  add_extra_edges(tri, node, dual);
  add_spares(tri, node, dual);
  return dual;
}

}  // namespace delquad
