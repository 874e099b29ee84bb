// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/treatment/local_remeshing.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "geometry/mesh/quad_corners.h"
#include "smoothing/relocation/untangling.h"

namespace delquad {

namespace {

/// Sweeps of relocation, and of lifting after untangling.
constexpr int kRelocationSweeps = 8, kLiftSweeps = 3;

/// Untangled rings around a quad: after edits of it, after edits of its neighbors, and at the last attempt,
/// which may move a whole tangle.
constexpr int kNearRings = 2, kFarRings = 3, kMostRings = 20;
/// Numbers of vertices above which a region grows no more; the second is for the last attempt.
constexpr int kLargeRegion = 40, kHugeRegion = 1500;

/// Limits of settled elements around vertices, with repetition: for each element of the mesh, and at least.
/// Patches with few bad quads need a tenth.
constexpr long long kSettledPerElement = 800, kLeastSettled = 80'000;

}  // namespace

LocalRemeshing::LocalRemeshing(QuadTopology& mesh, QuadRelocation& relocation, ShapePenalty& penalty)
    : mesh_(mesh),
      relocation_(relocation),
      penalty_(penalty),
      settlements_(kLeastSettled + kSettledPerElement * mesh.element_slots()) {}

bool LocalRemeshing::improve(int quad, double least_relief) {
  collect_region(quad, kNearRings, kLargeRegion);
  list_near_edits(quad);
  if (try_all(least_relief, false)) return true;
  if (least_sine(mesh_, quad) > kFlatSine) return false;
  collect_region(quad, kFarRings, kLargeRegion);
  list_far_edits(quad);
  if (try_all(least_relief, true)) return true;
  collect_region(quad, kMostRings, kHugeRegion);
  edits_.assign(1, {});
  add_pillow({quad});
  return try_all(least_relief, true);
}

/// Returns these elements and their neighbors across sides (or corners).
std::vector<int> LocalRemeshing::neighbours(std::span<const int> elements, bool across_corners) const {
  std::vector<int> all(elements.begin(), elements.end());
  for (const int e : elements)
    for (int k = 0; k < (mesh_.is_quad(e) ? 4 : 3); ++k) {
      const int h = 4 * e + k;
      if (across_corners)
        mesh_.for_each_out(mesh_.origin(h), [&](int g) { all.push_back(QuadTopology::element(g)); });
      else if (mesh_.twin(h) >= 0)
        all.push_back(QuadTopology::element(mesh_.twin(h)));
    }
  sort_unique(all);
  return all;
}

void LocalRemeshing::collect_region(int quad, int rings, int enough) {
  std::vector<int> elements{quad};
  for (int ring = 0;; ++ring) {
    region_.clear();
    for (const int e : elements)
      for (int k = 0; k < 4; ++k)
        if (const int v = mesh_.corner(e, k); v >= 0) region_.push_back(v);
    sort_unique(region_);
    if (ring == rings || static_cast<int>(region_.size()) > enough) return;
    elements = neighbours(elements, true);
  }
}

void LocalRemeshing::add_moves(int element) {
  for_each_move(mesh_, element, [&](const TreatmentMove& move) {
    if (is_legal(mesh_, move)) edits_.push_back({move, {}});
  });
}

void LocalRemeshing::add_pillow(std::vector<int> quads) {
  std::erase_if(quads, [&](int e) { return !mesh_.is_quad(e); });
  if (!quads.empty() && mesh_.can_pillow(quads) && !ring_divides_sharp_corner(mesh_, quads))
    edits_.push_back({{}, std::move(quads)});
}

void LocalRemeshing::list_near_edits(int quad) {
  edits_.assign(1, {});
  add_moves(quad);
  add_pillow({quad});
}

void LocalRemeshing::list_far_edits(int quad) {
  edits_.assign(1, {});
  const std::array<int, 1> self{quad};
  for (const int e : neighbours(self, false)) {
    add_moves(e);
    add_pillow({e});
    if (e != quad) add_pillow({quad, e});
  }
  add_pillow(neighbours(self, false));
  for (int k = 0; k < 4; ++k) {
    std::vector<int> fan;
    mesh_.for_each_out(mesh_.corner(quad, k), [&](int h) { fan.push_back(QuadTopology::element(h)); });
    add_pillow(std::move(fan));
  }
  const std::vector<int> ring = neighbours(self, true);
  add_pillow(ring);
  add_pillow(neighbours(ring, true));
}

void LocalRemeshing::perform(const Edit& edit) {
  const int first = mesh_.vertex_slots();
  if (!edit.pillow.empty())
    mesh_.pillow(edit.pillow);
  else if (edit.move.at >= 0)
    apply(mesh_, edit.move);
  if (first < mesh_.vertex_slots()) relocation_.adopt_new_vertices(first);
  for (int v = first; v < mesh_.vertex_slots(); ++v) region_.push_back(v);
  free_.clear();
  for (const int v : region_)
    if (mesh_.vertex_alive(v) && !mesh_.on_boundary(v)) free_.push_back(v);
  settle();
}

void LocalRemeshing::settle() {
  for (const int v : free_) settlements_ -= mesh_.valence(v);
  untangle(mesh_, free_);
  for (int sweep = 0; sweep < kRelocationSweeps; ++sweep)
    for (const int v : free_) relocation_.step(v);
  const double enough = sine_of_eta(kPoorEta);
  for (int sweep = 0; sweep < kLiftSweeps; ++sweep)
    for (const int v : free_) relocation_.lift(v, enough);
}

bool LocalRemeshing::try_all(double least_relief, bool first_will_do) {
  const double before = penalty_.around(region_);
  const std::size_t n_region = region_.size();
  const auto start = mesh_.mark();
  double best = before - least_relief;
  const Edit* choice = nullptr;
  for (const Edit& edit : edits_) {
    if (settlements_ <= 0) break;
    perform(edit);
    const double after = penalty_.around(region_);
    if (after < best) best = after, choice = &edit;
    mesh_.rollback(start);
    region_.resize(n_region);
    if (first_will_do && choice != nullptr) break;
  }
  if (choice == nullptr) return false;
  const int slots = mesh_.vertex_slots();
  perform(*choice);
  ring_quads_ = mesh_.vertex_slots() - slots;
  move_ = choice->move;
  return true;
}

namespace {

/// Weight of an element of eta 0. Sums over the others are below it, with some hundreds of corners.
constexpr double kFlatWeight = 1e4;

}  // namespace

double ShapePenalty::around(std::span<const int> vertices) {
  static const double poor = sine_of_eta(kPoorEta);
  double sum = 0;
  elements_met_.begin(mesh_.element_slots());
  for_each_element_around(mesh_, vertices, elements_met_, [&](int e) {
    ++looks_;
    double least = 1;
    for (const double sine : corner_sines(mesh_, e)) {
      const double deficit = std::max(0.0, 1 - sine / poor);
      sum += deficit * deficit * deficit;
      least = std::min(least, sine);
    }
    if (least <= kFlatSine) sum += kFlatWeight;
  });
  return sum;
}

}  // namespace delquad
