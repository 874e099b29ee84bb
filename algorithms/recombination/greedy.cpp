#include "algorithms/recombination/greedy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "algorithms/recombination/dual_graph.h"
#include "algorithms/recombination/quad_cost.h"
#include "algorithms/recombination/treatment_moves.h"
#include "smoothing/quad_relocation.h"

namespace delquad {
namespace {

struct Pair {
  double eta;
  int triangle, side;
};

/// Side k is no shorter than the others.
bool is_longest(const TriPatch& tri, int t, int k) {
  const auto& v = tri.triangles[t];
  const auto length = [&](int i) { return norm(tri.points[v[(i + 2) % 3]] - tri.points[v[(i + 1) % 3]]); };
  return length(k) >= length((k + 1) % 3) && length(k) >= length((k + 2) % 3);
}

/// The quad of a triangle and the one across its side k.
std::array<int, 4> merged(const TriPatch& tri, int t, int k) {
  const auto& v = tri.triangles[t];
  const int u = tri.neighbours[t][k];
  return {v[k], v[(k + 1) % 3], tri.triangles[u][facing_side(tri, u, t)], v[(k + 2) % 3]};
}

/// The quads that triangles may make, and which of them they do.
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
    const auto [a, b, c, d] = merged(tri_, t, k);
    const double eta = signed_eta(tri_.points[a], tri_.points[b], tri_.points[c], tri_.points[d]);
    if (eta >= options.least_eta) pairs_.push_back({eta, t, k});
  }

  void join(int t, int u) {
    mate_[t] = u;
    mate_[u] = t;
  }

  /// `search`: whose search this is; no triangle is passed twice in one.
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
  std::vector<std::vector<int>> pairs_at_;  ///< of each triangle the others, best first
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class DegreeTreatment {
 public:
  DegreeTreatment(const QuadPatch& mesh, const ParametricSize& size)
      : mesh_(mesh), size_(size), energy_(mesh_), hint_(mesh.points.size(), -1) {}

  QuadPatch run(int max_rounds, TreatmentSummary& s) {
    constexpr int kSweeps = 5;
    for (int changes = 1; s.rounds < max_rounds && changes > 0; ++s.rounds) {
      s.relocated += sweep();
      const int before = s.swaps + s.doublets + s.diamonds;
      for (int element = 0; element < mesh_.element_slots(); ++element) edit(element, s);
      changes = s.swaps + s.doublets + s.diamonds - before;
    }
    for (int k = 0; k < kSweeps; ++k) s.relocated += sweep();
    return mesh_.to_patch();
  }

 private:
  /// The first edit at the element that lowers the energy and leaves good elements.
  void edit(int element, TreatmentSummary& s) {
    std::vector<TreatmentMove> moves;
    for_each_move(mesh_, element, [&](const TreatmentMove& move) {
      if (is_legal(mesh_, move) && energy_.gain(move) > 0) moves.push_back(move);
    });
    for (const TreatmentMove& move : moves) {
      const TouchedVertices touched = touched_by(mesh_, move);
      const double before = worst_around(touched);
      const auto mark = mesh_.mark();
      apply(mesh_, move);
      for (const int v : touched) relocate(v);
      if (worst_around(touched) >= std::min(before, kGoodSine)) {
        mesh_.commit();
        ++(move.kind == TreatmentMove::kDoublet    ? s.doublets
           : move.kind == TreatmentMove::kCollapse ? s.diamonds
                                                   : s.swaps);
        return;
      }
      mesh_.rollback(mark);
    }
  }

  double worst_at(int v) const {
    double worst = 1;
    mesh_.for_each_out(v,
                       [&](int h) { worst = std::min(worst, least_sine(mesh_, QuadTopology::element(h))); });
    return worst;
  }
  double worst_around(const TouchedVertices& vertices) const {
    double worst = 1;
    for (const int v : vertices)
      if (mesh_.vertex_alive(v)) worst = std::min(worst, worst_at(v));
    return worst;
  }

  int sweep() {
    int moved = 0;
    for (int v = 0; v < mesh_.vertex_slots(); ++v) moved += relocate(v);
    mesh_.commit();
    return moved;
  }

  /// Half-way or less to the mean of the elements' best points.
  bool relocate(int v) {
    if (!mesh_.vertex_alive(v) || mesh_.on_boundary(v)) return false;
    Vec2 sum;
    double weights = 0;
    mesh_.for_each_out(v, [&](int h) {
      const bool is_quad = mesh_.is_quad(QuadTopology::element(h));
      const Vec2 a = mesh_.point(mesh_.target(h)), c = mesh_.point(mesh_.origin(mesh_.prev(h)));
      const Vec2 middle = 0.5 * (a + c);
      const double delta = size_.at(middle, hint_[v]);
      const double weight = 1 / (delta * delta), height = is_quad ? 0.5 : std::numbers::sqrt3 / 2;
      sum += weight * (middle + height * perp(c - a));
      weights += weight;
    });
    const Vec2 from = mesh_.point(v), way = (1 / weights) * sum - from;
    const double worst = worst_at(v);
    for (double part = 0.5; part > 0.1; part /= 2) {
      mesh_.move(v, from + part * way);
      if (worst_at(v) > worst) return true;
    }
    mesh_.move(v, from);
    return false;
  }

  static constexpr double kGoodSine = 0.5;
  QuadTopology mesh_;
  const ParametricSize& size_;
  ValenceEnergy energy_;
  std::vector<int> hint_;
};

}  // namespace

QuadPatch recombine_greedily(const TriPatch& tri, const GreedyOptions& options, RecombineSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  QuadPatch mesh;
  mesh.points = tri.points;
  mesh.n_boundary = tri.n_boundary;
  Pairing pairing(tri, options);
  pairing.merge_best_first();
  pairing.exchange(options.exchanges);
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    const int u = pairing.mate(t);
    if (u < 0) mesh.triangles.push_back(tri.triangles[t]);
    if (u > t) mesh.quads.push_back(merged(tri, t, facing_side(tri, t, u)));
  }
  if (summary != nullptr) {
    *summary = {};
    summary->triangles = static_cast<int>(tri.triangles.size());
    summary->leftover_triangles = static_cast<int>(mesh.triangles.size());
    summary->merge_seconds = seconds_since(start);
  }
  return mesh;
}

QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size, const TreatmentOptions& options,
                           TreatmentSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  TreatmentSummary s;
  QuadPatch treated = DegreeTreatment(mesh, size).run(options.max_rounds, s);
  s.seconds = seconds_since(start);
  if (summary != nullptr) *summary = s;
  return treated;
}

}  // namespace delquad
