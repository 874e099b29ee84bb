// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/recombine.h"

#include <algorithm>
#include <cassert>

#include "base/stopwatch.h"
#include "geometry/mesh/tri_topology.h"

namespace delquad {
namespace {

struct Pair {
  double eta;
  int triangle, side;
};

/// Returns whether side k is at least as long as the others.
bool is_longest(const TriPatch& tri, int t, int k) {
  const auto& v = tri.triangles[t];
  const auto length = [&](int i) { return norm(tri.points[v[(i + 2) % 3]] - tri.points[v[(i + 1) % 3]]); };
  return length(k) >= length((k + 1) % 3) && length(k) >= length((k + 2) % 3);
}

/// The possible quads of triangles, and the chosen ones.
class Pairing {
 public:
  Pairing(const TriPatch& tri, const GreedyOptions& options)
      : tri_(tri),
        mate_(tri.triangles.size(), -1),
        searched_(tri.triangles.size(), -1),
        pairs_at_(mate_.size()) {
    for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) add_candidate(t, k, options);
    std::ranges::sort(pairs_, [](const Pair& a, const Pair& b) {
      return std::tuple(-a.eta, a.triangle, a.side) < std::tuple(-b.eta, b.triangle, b.side);
    });
    for (const Pair& pair : pairs_) {
      const int u = tri.neighbours[pair.triangle][pair.side];
      pairs_at_[pair.triangle].push_back(u);
      pairs_at_[u].push_back(pair.triangle);
    }
  }

  void merge_best_first() {
    for (const Pair& pair : pairs_) {
      const int t = pair.triangle, u = tri_.neighbours[t][pair.side];
      if (mate_[t] < 0 && mate_[u] < 0) join(t, u);
    }
  }

  void exchange(int quads) {
    for (int t = 0; t < static_cast<int>(mate_.size()); ++t)
      if (mate_[t] < 0) find_mate(t, quads, t);
  }

  int mate(int t) const { return mate_[t]; }

 private:
  void add_candidate(int t, int k, const GreedyOptions& options) {
    const int u = tri_.neighbours[t][k];
    if (u < t) return;
    if (options.longest_side && !is_longest(tri_, t, k) && !is_longest(tri_, u, facing_side(tri_, u, t)))
      return;
    const auto [a, b, c, d] = merged_quad(tri_, t, k, u);
    const double eta = signed_eta(tri_.points[a], tri_.points[b], tri_.points[c], tri_.points[d]);
    if (eta >= options.least_eta) pairs_.push_back({eta, t, k});
  }

  void join(int t, int u) {
    mate_[t] = u;
    mate_[u] = t;
  }

  /// Finds a mate for t by changes of at most `quads` quads. `search` is the number of a search; each visits
  /// a triangle at most once.
  bool find_mate(int t, int quads, int search) {
    searched_[t] = search;
    for (const int u : pairs_at_[t]) {
      const int other = mate_[u];
      if (searched_[u] == search || (other >= 0 && (quads == 0 || searched_[other] == search))) continue;
      searched_[u] = search;
      if (other >= 0 && !find_mate(other, quads - 1, search)) continue;
      join(t, u);
      return true;
    }
    return false;
  }

  const TriPatch& tri_;
  std::vector<Pair> pairs_;  ///< best first
  std::vector<int> mate_, searched_;
  std::vector<std::vector<int>> pairs_at_;  ///< possible partners of each triangle, best first
};

}  // namespace

QuadPatch recombine_greedily(const TriPatch& tri, const GreedyOptions& options, RecombineSummary* summary) {
  assert(options.least_eta > 0);
  const Stopwatch watch;
  QuadPatch mesh;
  mesh.points = tri.points;
  mesh.n_boundary = tri.n_boundary;
  Pairing pairing(tri, options);
  pairing.merge_best_first();
  pairing.exchange(options.exchanges);
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    const int u = pairing.mate(t);
    if (u < 0) mesh.triangles.push_back(tri.triangles[t]);
    if (u > t) mesh.quads.push_back(merged_quad(tri, t, facing_side(tri, t, u), u));
  }
  if (summary != nullptr) {
    *summary = {};
    summary->triangles = static_cast<int>(tri.triangles.size());
    summary->leftover_triangles = static_cast<int>(mesh.triangles.size());
    summary->merge_seconds = watch.seconds();
  }
  return mesh;
}

}  // namespace delquad
