// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/lift_bad_quads.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/finish/edit_failing.h"
#include "base/parallel.h"
#include "geometry/patches/meshing_setup.h"
#include "metrics/shape.h"
#include "metrics/surface/surface_search.h"
#include "smoothing/relocation/quad_relocation.h"
#include "smoothing/surface/surface_lift.h"
#include "smoothing/surface/surface_tracks.h"

namespace delquad {
namespace {

/// Quads below this eta in space are lifted, in this many sweeps.
constexpr double kPoorInSpace = 0.3;
constexpr int kLiftSweeps = 20;
/// Sweeps that move failing quads.
constexpr int kRepairSweeps = 6;
/// Quads of at most this eta are flat, and hardly better than inverted.
constexpr double kFlat = 1e-3;
/// Passes that add rings.
constexpr int kRingPasses = 3;
/// Trials of edits; quads of all meshes of these trials; edits of one quad.
constexpr int kMostTrials = 200, kMostTried = 1'000'000, kWays = 21;
/// Limit of tried places of vertices, see lift_worst_on_surface(): by the quads, and about ten seconds.
constexpr long long kLeastCost = 500'000, kCostPerQuad = 300, kMostCost = 8'000'000;
/// Limit for failing quads: about five seconds.
constexpr long long kMostRepairs = 5'000'000;

/// Badness of a quad that is inverted, folded or turned away from the model; a flat quad has 1.
constexpr int kUnsound = 1000;

/// Measures the badness of quads.
class Badness {
 public:
  explicit Badness(const Mesh& fine) : fine_(fine) {}

  /// Returns the badness of a quad. `around` is the sum of the unit normals of the quads at its corners. A
  /// quad that agrees with it is well oriented; the exact test is slow.
  int operator()(const std::array<Vec3, 4>& corners, const Vec3& around, int face) const {
    constexpr double kAgrees = 0.5;  // a cosine
    const Vec3 area = area_vector(corners);
    const ElementShape<4> shape = element_shape(corners, area);
    if (!is_readable(corners, area, shape) || quad_warp(corners) > kFold) return kUnsound;
    if (dot(area, around) < kAgrees * norm(area) * norm(around) && is_turned(corners, area, face))
      return kUnsound;
    return eta_of(shape.angle) > kFlat ? 0 : 1;
  }

 private:
  bool is_turned(const std::array<Vec3, 4>& corners, const Vec3& area, int face) const {
    std::call_once(is_requested_, [&] { normals_.emplace(fine_); });
    Vec3 centre;
    double reach = 0;
    for (const Vec3& x : corners) centre = centre + 0.25 * x;
    for (const Vec3& x : corners) reach = std::max(reach, norm(x - centre));
    return normals_->all_point_away({centre, face}, area, reach);
  }

  const Mesh& fine_;
  mutable std::once_flag is_requested_;
  mutable std::optional<FaceNormals> normals_;
};

/// Returns the patches of quads that are not left out.
std::vector<std::size_t> patches_of_quads(const AllPatches& in) {
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < in.patches.size(); ++i)
    if (in.patches[i].form == PatchForm::kQuads && !in.left_out[i]) which.push_back(i);
  return which;
}

/// Moves vertices on the tracks of these patches. Returns how many moved.
template <class Move>
int move_on_tracks(const AllPatches& in, const std::vector<std::size_t>& which, const Move& move) {
  const SurfaceSetup& surface = *in.prepared.surface;
  std::vector<SurfaceTracks::Patch> moving;
  for (const std::size_t i : which)
    moving.push_back({&surface.domain.patches[i], in.prepared.patches[i].cross.get(), &in.patches[i].quads,
                      &in.patches[i].inside});
  SurfaceTracks tracks(surface.model, *surface.size, surface.domain, in.nodes, std::move(moving));
  std::vector<Vec3> places = tracks.points();
  const int moved = move(tracks, places);
  if (moved > 0) tracks.store(places);
  return moved;
}

int lift_all(const AllPatches& in, const std::vector<std::size_t>& which, Budget& trials,
             const LiftedBall& ball = {}) {
  return move_on_tracks(in, which, [&](SurfaceTracks& tracks, std::vector<Vec3>& places) {
    return lift_worst_on_surface(tracks, places, kPoorInSpace, kLiftSweeps, trials, ball);
  });
}

struct BadQuad {
  int badness;
  std::size_t patch;
  int quad;
  LiftedBall around;  ///< region that an edit may change
};

/// Returns the ball around the middle of a quad; its radius is kReach times the farthest corner.
LiftedBall ball_around(const std::array<Vec3, 4>& corners) {
  constexpr double kReach = 5;
  LiftedBall ball{0.25 * (corners[0] + corners[1] + corners[2] + corners[3]), 0};
  for (const Vec3& x : corners) ball.radius = std::max(ball.radius, kReach * norm(x - ball.centre));
  return ball;
}

/// Returns the places in space of the vertices of a patch.
std::vector<Vec3> places_of(const AllPatches& in, std::size_t patch) {
  std::vector<Vec3> places;
  for (const int node : in.prepared.patches[patch].boundary.point_node)
    places.push_back(in.nodes.points[node]);
  const std::vector<Vec3>& inside = in.patches[patch].inside;
  places.insert(places.end(), inside.begin(), inside.end());
  return places;
}

/// Returns patch `one`, patches that reach into the ball, and patches that share nodes with these. Lifting in
/// the ball touches no others.
std::vector<std::size_t> patches_near(const AllPatches& in, const std::vector<std::size_t>& which,
                                      std::size_t one, const LiftedBall& ball) {
  const auto nodes_of = [&](std::size_t p) -> const std::vector<int>& {
    return in.prepared.patches[p].boundary.point_node;
  };
  const auto reaches_in = [&](const Vec3& x) { return norm(x - ball.centre) < ball.radius; };
  std::vector<char> near(in.nodes.points.size(), 0);
  for (const std::size_t p : which)
    if (p == one || std::ranges::any_of(places_of(in, p), reaches_in))
      for (const int node : nodes_of(p)) near[node] = 1;
  std::vector<std::size_t> found;
  std::ranges::copy_if(which, std::back_inserter(found), [&](std::size_t p) {
    return std::ranges::any_of(nodes_of(p), [&](int node) { return near[node] != 0; });
  });
  return found;
}

/// Returns the bad quads of a patch, measured in space.
std::vector<BadQuad> bad_quads(const AllPatches& in, const Badness& badness_of, std::size_t patch) {
  const QuadPatch& mesh = in.patches[patch].quads;
  const std::vector<Vec3> place = places_of(in, patch);
  const auto corners = [&](std::size_t q) {
    const auto& [a, b, c, d] = mesh.quads[q];
    return std::array{place[a], place[b], place[c], place[d]};
  };
  std::vector<Vec3> around(mesh.points.size());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const Vec3 area = area_vector(corners(q));
    if (!(norm(area) > 0)) continue;
    for (const int v : mesh.quads[q]) around[v] = around[v] + (1 / norm(area)) * area;
  }
  std::vector<BadQuad> bad;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& [a, b, c, d] = mesh.quads[q];
    const int badness = badness_of(corners(q), around[a] + around[b] + around[c] + around[d],
                                   in.prepared.patches[patch].region);
    if (badness > 0) bad.push_back({badness, patch, static_cast<int>(q), ball_around(corners(q))});
  }
  return bad;
}

/// Returns the bad quads of these patches, worst first.
std::vector<BadQuad> all_bad_quads(const AllPatches& in, const Badness& badness_of,
                                   const std::vector<std::size_t>& which) {
  std::vector<std::vector<BadQuad>> found(which.size());
  parallel_for(
      which.size(), [&](std::size_t k) { found[k] = bad_quads(in, badness_of, which[k]); },
      [&](std::size_t k) { return static_cast<double>(in.patches[which[k]].quads.quads.size()); });
  std::vector<BadQuad> bad;
  for (const auto& of_patch : found) bad.insert(bad.end(), of_patch.begin(), of_patch.end());
  std::ranges::stable_sort(bad, std::greater<>(), &BadQuad::badness);
  return bad;
}

int total(const std::vector<BadQuad>& bad) {
  int sum = 0;
  for (const BadQuad& b : bad) sum += b.badness;
  return sum;
}

/// Saved patches and nodes, to undo an edit.
class State {
 public:
  State(const AllPatches& in, const std::vector<std::size_t>& which)
      : in_(in), which_(which), nodes_(in.nodes) {
    for (const std::size_t i : which) patches_.push_back(in.patches[i]);
  }
  void restore() const {
    for (std::size_t k = 0; k < which_.size(); ++k) in_.patches[which_[k]] = patches_[k];
    in_.nodes = nodes_;
  }

 private:
  const AllPatches& in_;
  const std::vector<std::size_t>& which_;
  SurfaceNodes nodes_;
  std::vector<PatchMesh> patches_;
};

/// Writes the quads and places in space of a patch back. Old vertices keep their places.
void store(const AllPatches& in, std::size_t p, const QuadTopology& mesh) {
  const SurfaceSetup& surface = *in.prepared.surface;
  PatchMesh& patch = in.patches[p];
  const int n_boundary = static_cast<int>(in.prepared.patches[p].boundary.point_node.size());
  const int n_before = n_boundary + static_cast<int>(patch.inside.size());
  std::vector<Vec3> inside;
  int hint = -1;
  for (int v = n_boundary; v < mesh.vertex_slots(); ++v)
    if (mesh.vertex_alive(v))
      inside.push_back(v < n_before ? patch.inside[v - n_boundary]
                                    : lift(surface.domain.patches[p], surface.model, mesh.point(v), hint));
  patch.inside = std::move(inside);
  patch.quads = mesh.to_patch();
}

/// Relocates the vertices from slot `first` on in the plane.
void settle(const QuadTopology& mesh, QuadRelocation& relocation, int first) {
  constexpr int kSweeps = 8;
  relocation.adopt_new_vertices(first);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int v = first; v < mesh.vertex_slots(); ++v) relocation.step(v);
}

/// Adds a ring inside each unsound quad. Returns how many.
int add_rings(const AllPatches& in, const std::vector<BadQuad>& bad) {
  std::map<std::size_t, std::vector<int>> quads_of;  // by patch
  for (const BadQuad& b : bad)
    if (b.badness == kUnsound) quads_of[b.patch].push_back(b.quad);
  int rings = 0;
  for (const auto& [p, quads] : quads_of) {
    QuadTopology mesh(in.patches[p].quads);
    QuadRelocation relocation(mesh, *in.prepared.patches[p].size);
    for (const int q : quads) {
      const std::array<int, 1> quad{q};
      if (!mesh.can_pillow(quad)) continue;
      const int first = mesh.vertex_slots();
      mesh.pillow(quad);
      settle(mesh, relocation, first);
      ++rings;
    }
    store(in, p, mesh);
  }
  return rings;
}

/// Applies edit `way` to a quad: it collapses, rotates or opens an edge, or adds a ring. Returns false if it
/// is impossible.
bool change(QuadTopology& mesh, int quad, int way) {
  const int h = 4 * quad + way % 4, kind = way / 4;
  const bool counterclockwise = kind % 2 == 0, is_inner = mesh.twin(h) >= 0;
  if (kind == 0 && mesh.can_collapse(h)) return mesh.collapse(h), true;
  if ((kind == 1 || kind == 2) && is_inner && mesh.can_rotate(h, counterclockwise))
    return mesh.rotate(h, counterclockwise), true;
  if ((kind == 3 || kind == 4) && is_inner && mesh.can_open(h)) return mesh.open(h, counterclockwise), true;
  const std::array<int, 1> ring{quad};
  if (way == kWays - 1 && mesh.can_pillow(ring)) return mesh.pillow(ring), true;
  return false;
}

/// Returns the bad quads after `now` replaces the bad quads of patches `changed`.
std::vector<BadQuad> with_changed(std::vector<BadQuad> bad, const std::vector<std::size_t>& changed,
                                  const std::vector<BadQuad>& now) {
  std::erase_if(bad, [&](const BadQuad& b) { return std::ranges::binary_search(changed, b.patch); });
  bad.insert(bad.end(), now.begin(), now.end());
  std::ranges::sort(bad, {}, [](const BadQuad& b) { return std::tuple(-b.badness, b.patch, b.quad); });
  return bad;
}

/// Edits the quads around the first bad quad that improves, and lifts them. Returns false if none improves.
bool repair_one(const AllPatches& in, const Badness& badness_of, const std::vector<std::size_t>& which,
                std::vector<BadQuad>& bad, int& trials, Budget& cost, LiftingSummary& summary) {
  for (const auto& [badness, p, quad, around] : bad) {
    if (trials <= 0 || cost.is_spent()) return false;
    const std::vector<std::size_t> near = patches_near(in, which, p, around);
    const State before(in, near);
    for (int way = 0; way < kWays && trials > 0; ++way) {
      QuadTopology mesh(in.patches[p].quads);
      QuadRelocation relocation(mesh, *in.prepared.patches[p].size);
      const int first = mesh.vertex_slots();
      if (!change(mesh, quad, way)) continue;
      --trials;
      settle(mesh, relocation, first);
      store(in, p, mesh);
      const int moved = lift_all(in, near, cost, around);
      std::vector<BadQuad> left = with_changed(bad, near, all_bad_quads(in, badness_of, near));
      if (total(left) < total(bad)) {
        summary.moved += moved;
        ++summary.repaired;
        bad = std::move(left);
        return true;
      }
      before.restore();
    }
  }
  return false;
}

}  // namespace

LiftingSummary lift_bad_quads(const AllPatches& in) {
  LiftingSummary summary;
  const std::vector<std::size_t> which = patches_of_quads(in);
  place_inside(in);
  std::size_t n_quads = 1;
  for (const std::size_t i : which) n_quads += in.patches[i].quads.quads.size();
  const auto by_quads = kLeastCost + kCostPerQuad * static_cast<long long>(n_quads);
  const long long most_cost = std::min(by_quads, kMostCost);
  Budget cost(most_cost);
  summary.moved = lift_all(in, which, cost);

  const Badness badness_of(in.prepared.surface->model.fine);
  std::vector<BadQuad> bad = all_bad_quads(in, badness_of, which);
  const int most = static_cast<int>(std::min<std::size_t>(kMostTrials, kMostTried / n_quads));
  int trials = most;
  // Rings make a mesh less regular, so a given mesh gets them last.
  if (in.prepared.surface->given)
    while (repair_one(in, badness_of, which, bad, trials, cost, summary)) continue;
  trials = most;
  for (int pass = 0; pass < kRingPasses && total(bad) >= kUnsound; ++pass) {
    const State before(in, which);
    const int rings = add_rings(in, bad);
    if (rings == 0) break;
    const int moved = lift_all(in, which, cost);
    std::vector<BadQuad> left = all_bad_quads(in, badness_of, which);
    if (total(left) >= total(bad)) {
      before.restore();
      break;
    }
    summary.moved += moved;
    summary.rings += rings;
    bad = std::move(left);
  }
  while (repair_one(in, badness_of, which, bad, trials, cost, summary)) continue;
  summary.cost = most_cost - cost.left();
  if (cost.is_spent() && !bad.empty())
    summary.stopped = in.prepared.boundary.regions[in.prepared.patches[bad[0].patch].region].tag;
  return summary;
}

FailingRepairSummary repair_failing_quads(const AllPatches& in, const SpaceLimits& limits) {
  FailingRepairSummary summary;
  const std::vector<std::size_t> which = patches_of_quads(in);
  place_inside(in);
  if (total(all_bad_quads(in, Badness(in.prepared.surface->model.fine), which)) >= kUnsound) return summary;
  Budget trials(kMostRepairs);
  const auto move = [&] {
    summary.moved += move_on_tracks(in, which, [&](SurfaceTracks& tracks, std::vector<Vec3>& places) {
      return repair_failing_on_surface(tracks, places, limits, kRepairSweeps, trials);
    });
  };
  move();
  if (!in.prepared.boundary.periodic_faces.empty()) return summary;  // images of faces must not change
  std::vector<int> edits(which.size());
  parallel_for(
      which.size(), [&](std::size_t k) { edits[k] = edit_failing(in, which[k], limits); },
      [&](std::size_t k) { return static_cast<double>(in.patches[which[k]].quads.quads.size()); });
  summary.edited = std::accumulate(edits.begin(), edits.end(), 0);
  if (summary.edited > 0) move();
  return summary;
}

}  // namespace delquad
