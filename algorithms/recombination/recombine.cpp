// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/recombine.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "base/parallel_collect.h"
#include "geometry/mesh/tri_topology.h"

namespace delquad {

namespace {

/// Returns the seconds since the last call.
class LapTimer {
 public:
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> lap = now - last_;
    last_ = now;
    return lap.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Pairs that are processed together, so that their data can be prefetched.
constexpr std::size_t kPairsPerBlock = 256;

/// Lists the triangles of pairs that are matched through their lower nodes in [begin, end). Returns their
/// number.
std::size_t list_pairs(const TriPatch& tri, const DualGraph& dual, const std::vector<int>& mate,
                       std::size_t begin, std::size_t end,
                       std::array<std::pair<int, int>, kPairsPerBlock>& pairs) {
  const int n = static_cast<int>(dual.triangle.size());
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const int j = mate[i];
    if (j >= n || j < static_cast<int>(i)) continue;
    const int t = dual.triangle[i], u = dual.triangle[j];
    __builtin_prefetch(&tri.triangles[t]);
    __builtin_prefetch(&tri.neighbours[t]);
    __builtin_prefetch(&tri.triangles[u]);
    pairs[count++] = {t, u};
  }
  return count;
}

/// Returns the quads of all matched pairs that share a side.
std::vector<std::array<int, 4>> merged_pairs(const TriPatch& tri, const DualGraph& dual,
                                             const std::vector<int>& mate) {
  using Quads = std::vector<std::array<int, 4>>;
  return parallel_collect<std::array<int, 4>>(
      dual.triangle.size(), [&](std::size_t begin, std::size_t end, Quads& quads) {
        quads.reserve(end - begin);
        std::array<std::pair<int, int>, kPairsPerBlock> pairs;
        for (; begin < end; begin += kPairsPerBlock) {
          const std::size_t count =
              list_pairs(tri, dual, mate, begin, std::min(begin + kPairsPerBlock, end), pairs);
          for (std::size_t k = 0; k < count; ++k) {
            const auto [t, u] = pairs[k];
            const int side = facing_side(tri, t, u);
            if (side >= 0) quads.push_back(merged_quad(tri, t, side, u));  // else matched by an extra edge
          }
        }
      });
}

/// Returns these quads, and the triangles matched with a spare.
QuadPatch merge(const TriPatch& tri, const DualGraph& dual, const std::vector<int>& mate) {
  QuadPatch mesh;
  mesh.points = tri.points;
  mesh.n_boundary = tri.n_boundary;
  mesh.quads = merged_pairs(tri, dual, mate);
  for (std::size_t spare = dual.triangle.size(); spare < mate.size(); ++spare) {
    mesh.triangles.push_back(tri.triangles[dual.triangle[mate[spare]]]);
  }
  return mesh;
}

/// Returns the triangle, rotated to start with vertex b.
std::array<int, 3> starting_at(const std::array<int, 3>& v, int b) {
  if (v[1] == b) return {v[1], v[2], v[0]};
  if (v[2] == b) return {v[2], v[0], v[1]};
  return v;
}

std::vector<FanEnds> matched_extra_edges(const TriPatch& tri, const DualGraph& dual,
                                         const std::vector<int>& mate) {
  std::vector<FanEnds> pairs;
  for (std::size_t k = 0; k < dual.extra_vertex.size(); ++k) {
    const MatchingGraph::Edge& e = dual.graph.edges[dual.first_extra + k];
    if (mate[e.a] != e.b) continue;
    const int b = dual.extra_vertex[k];
    pairs.push_back({starting_at(tri.triangles[dual.triangle[e.a]], b),
                     starting_at(tri.triangles[dual.triangle[e.b]], b)});
  }
  return pairs;
}

}  // namespace

QuadPatch recombine(const TriPatch& tri, const MatchingSolver& solver, RecombineSummary* summary,
                    long long extra_edge_cost, const AddedCost& cost) {
  RecombineSummary s;
  s.triangles = static_cast<int>(tri.triangles.size());
  LapTimer lap;
  DualGraph dual = build_dual_graph(tri, extra_edge_cost);
  if (cost) cost(tri, dual);
  s.graph_seconds = lap();
  MatchingResult matching = solver.solve(dual.graph);
  s.matching_seconds = lap();

  const TriPatch* mesh = &tri;
  TriPatch cut;
  if (matching.status == MatchingStatus::kNotPerfect) {
    cut = tri;
    s.split_chords = split_spanning_sides(cut);
    mesh = &cut;
    dual = build_dual_graph(cut, extra_edge_cost);
    if (cost) cost(cut, dual);
    s.graph_seconds += lap();
    matching = solver.solve(dual.graph);
    s.matching_seconds += lap();
    if (matching.status == MatchingStatus::kNotPerfect) {
      throw std::logic_error(solver.name() +
                             " finds no perfect matching although no inner side joins two boundary points");
    }
  }

  QuadPatch quads = merge(*mesh, dual, matching.mate);
  const std::vector<FanEnds> pairs = matched_extra_edges(*mesh, dual, matching.mate);
  const BoundaryRepairSummary repairs = repair_fans(quads, pairs);
  s.extra_edges = static_cast<int>(dual.extra_vertex.size());
  s.matched_extra = static_cast<int>(pairs.size());
  s.pentagon_swaps = repairs.pentagon_swaps;
  s.duplications = repairs.duplications;
  s.leftover_triangles = static_cast<int>(quads.triangles.size());
  s.cost = matching.cost;
  s.solver = std::move(matching.fields);
  s.merge_seconds = lap();
  if (summary != nullptr) *summary = s;
  return quads;
}

namespace {

/// Returns an interior side of t between two boundary points; -1: none.
int spanning_side_of(const TriPatch& tri, int t) {
  for (int side = 0; side < 3; ++side) {
    if (tri.neighbours[t][side] >= 0 && tri.triangles[t][(side + 1) % 3] < tri.n_boundary &&
        tri.triangles[t][(side + 2) % 3] < tri.n_boundary) {
      return side;
    }
  }
  return -1;
}

}  // namespace

int split_spanning_sides(TriPatch& tri) {
  int cuts = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int side = spanning_side_of(tri, static_cast<int>(t)); side >= 0;
         side = spanning_side_of(tri, static_cast<int>(t))) {
      const auto& v = tri.triangles[t];
      split_side(tri, static_cast<int>(t), side,
                 0.5 * (tri.points[v[(side + 1) % 3]] + tri.points[v[(side + 2) % 3]]));
      ++cuts;
    }
  }
  return cuts;
}

}  // namespace delquad
