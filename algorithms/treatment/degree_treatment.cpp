// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/treatment/treatment.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "base/cancel.h"
#include "base/stopwatch.h"

namespace delquad {
namespace {

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
  /// Applies the first edit at the element that lowers the energy and leaves good elements.
  void edit(int element, TreatmentSummary& s) {
    check_cancelled();
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
    for (int v = 0; v < mesh_.vertex_slots(); ++v) {
      check_cancelled();
      moved += relocate(v);
    }
    mesh_.commit();
    return moved;
  }

  /// Moves v at most half-way to the mean of the best points of its elements.
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

QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size, const TreatmentOptions& options,
                           TreatmentSummary* summary) {
  const Stopwatch watch;
  TreatmentSummary s;
  QuadPatch treated = DegreeTreatment(mesh, size).run(options.max_rounds, s);
  s.seconds = watch.seconds();
  if (summary != nullptr) *summary = s;
  return treated;
}

}  // namespace delquad
