// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/edit_failing.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "base/cancel.h"
#include "base/marks.h"
#include "base/sort_unique.h"
#include "geometry/patches/meshing_setup.h"
#include "metrics/shape.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {
namespace {

/// Limit of tried edits in a patch, and sweeps of relocation after each.
constexpr int kMostEdits = 2000, kSettlingSweeps = 6;
/// Allowed loss of eta, summed over the quads around, for each failing quad that an edit removes.
constexpr double kPriceOfFailing = 1;
/// Least part of the kept eta, or of the worst eta around, that an edit must keep; for given quads 1.
constexpr double kKeptPart = 0.9;

/// Sums and the worst value over quads around some vertices.
struct QuadsAround {
  int failing = 0;
  double deficit = 0, worst = 1;  ///< sum of 1 - eta; least eta
  int ties = 0;    ///< chords and corners that another face may share, see separate_duplicates()
  Vec3 area = {};  ///< area vector
};

class FailingEdits {
 public:
  FailingEdits(const AllPatches& in, std::size_t patch, const SpaceLimits& limits)
      : surface_(*in.prepared.surface),
        domain_(surface_.domain.patches[patch]),
        mesh_(in.patches[patch].quads),
        relocation_(mesh_, *in.prepared.patches[patch].size),
        limits_(limits),
        kept_(surface_.given ? 1 : kKeptPart),
        positions_(in.patches[patch].quads.points) {
    for (const int node : in.prepared.patches[patch].boundary.point_node)
      places_.push_back(in.nodes.points[node]);
    const std::vector<Vec3>& inside = in.patches[patch].inside;
    places_.insert(places_.end(), inside.begin(), inside.end());
    relocation_.keep_convex_corners();
    relocation_.hold_lengths();
    relocation_.keep_sines_above(sine_of_eta(limits_.kept.eta));
  }

  int run() {
    int edits = 0;
    for (int e = 0; e < mesh_.element_slots() && trials_ > 0; ++e)
      if (mesh_.is_quad(e) && is_failing(corners(e))) edits += repair(e);
    return edits;
  }

  void store(PatchMesh& patch) const {
    patch.inside.clear();
    for (int v = patch.quads.n_boundary; v < mesh_.vertex_slots(); ++v)
      if (mesh_.vertex_alive(v)) patch.inside.push_back(place(v));
    patch.quads = mesh_.to_patch();
  }

 private:
  /// Returns the known place of v; if v moved in the plane, the place of its lifted point.
  Vec3 place(int v) const {
    if (static_cast<std::size_t>(v) < places_.size() && mesh_.point(v) == positions_[v]) return places_[v];
    return lift(domain_, surface_.model, mesh_.point(v), hint_);
  }

  std::array<Vec3, 4> corners(int quad) const {
    std::array<Vec3, 4> at;
    for (int k = 0; k < 4; ++k) at[k] = place(mesh_.corner(quad, k));
    return at;
  }

  static double eta(const std::array<Vec3, 4>& at) {
    return eta_of(element_shape(at, area_vector(at)).angle);
  }

  bool is_failing(const std::array<Vec3, 4>& at) const {
    int hint = -1;
    return limits_.excess(at, limits_.size.at(0.25 * (at[0] + at[1] + at[2] + at[3]), hint)) > 0;
  }

  template <class F>
  void for_each_touched(F&& f) {
    met_.begin(mesh_.element_slots());
    for_each_element_around(mesh_, touched_, met_, f);
  }

  ElementQuality in_plane() {
    ElementQuality total;
    for_each_touched([&](int e) { total.add(element_quality(mesh_, relocation_, e)); });
    return total;
  }

  QuadsAround in_space() {
    QuadsAround sum;
    for_each_touched([&](int e) {
      if (!mesh_.is_quad(e)) return;
      const auto at = corners(e);
      sum.failing += is_failing(at);
      sum.deficit += 1 - eta(at), sum.worst = std::min(sum.worst, eta(at));
      sum.area = sum.area + area_vector(at);
      for (int h = 4 * e; h < 4 * e + 4; ++h)
        if (const int v = mesh_.origin(h); mesh_.on_boundary(v))
          sum.ties += (mesh_.valence(v) == 1) + (mesh_.twin(h) >= 0 && mesh_.on_boundary(mesh_.target(h)));
    });
    return sum;
  }

  bool some_turn_from(const Vec3& area) {
    bool some = false;
    for_each_touched(
        [&](int e) { some = some || (mesh_.is_quad(e) && !(dot(area_vector(corners(e)), area) > 0)); });
    return some;
  }

  std::vector<TreatmentMove> moves_around(int quad) const {
    std::vector<TreatmentMove> moves;
    const auto add = [&](const TreatmentMove& move) {
      if (is_legal(mesh_, move)) moves.push_back(move);
    };
    for (int k = 0; k < 4; ++k) {
      mesh_.for_each_out(mesh_.corner(quad, k), [&](int h) {
        for_each_move(mesh_, QuadTopology::element(h), add);
        if (mesh_.twin(h) >= 0)
          for (const auto kind : {TreatmentMove::kOpenForward, TreatmentMove::kOpenBackward}) add({kind, h});
      });
      for_each_split(mesh_, mesh_.corner(quad, k), add);
    }
    sort_unique(moves);
    return moves;
  }

  /// Applies an edit. Returns its gain, at most 0 if it is not acceptable.
  double attempt(const TreatmentMove& move) {
    --trials_;
    const TouchedVertices touched = touched_by(mesh_, move);
    touched_.assign(touched.begin(), touched.end());
    const ElementQuality flat = in_plane();
    const QuadsAround before = in_space();
    apply(mesh_, relocation_, move, touched_);
    for (int sweep = 0; sweep < kSettlingSweeps; ++sweep)
      for (const int v : touched_) relocation_.step(v);
    const ElementQuality settled = in_plane();
    if (settled.least_sine < kept_ * std::min(flat.least_sine, sine_of_eta(limits_.kept.eta)) ||
        settled.failing > flat.failing || settled.crowding > flat.crowding)
      return 0;  // checked first, since places in space take longer
    const QuadsAround after = in_space();
    if (after.failing >= before.failing || after.ties > before.ties ||
        after.worst < kept_ * std::min(before.worst, limits_.kept.eta) || some_turn_from(before.area))
      return 0;
    return kPriceOfFailing * (before.failing - after.failing) - (after.deficit - before.deficit);
  }

  bool repair(int quad) {
    check_cancelled();
    std::optional<TreatmentMove> best;
    double most = 0;
    for (const TreatmentMove& move : moves_around(quad)) {
      const auto start = mesh_.mark();
      if (const double gain = attempt(move); gain > most) most = gain, best = move;
      mesh_.rollback(start);
    }
    if (!best) return false;
    attempt(*best);
    mesh_.commit();
    places_.resize(mesh_.vertex_slots()), positions_.resize(mesh_.vertex_slots());
    for (const int v : touched_)
      if (mesh_.vertex_alive(v)) places_[v] = place(v), positions_[v] = mesh_.point(v);
    return true;
  }

  const SurfaceSetup& surface_;
  const SurfacePatch& domain_;
  QuadTopology mesh_;
  QuadRelocation relocation_;
  const SpaceLimits& limits_;
  const double kept_;            ///< least kept part of eta
  std::vector<Vec2> positions_;  ///< places of vertices in the plane
  std::vector<Vec3> places_;     ///< their places in space
  std::vector<int> touched_;     ///< vertices of the edit on trial
  int trials_ = kMostEdits;      ///< number of edits that may still be tried
  mutable int hint_ = -1;
  Marks met_;
};

}  // namespace

int edit_failing(const AllPatches& in, std::size_t patch, const SpaceLimits& limits) {
  FailingEdits edits(in, patch, limits);
  const int made = edits.run();
  if (made > 0) edits.store(in.patches[patch]);
  return made;
}

}  // namespace delquad
