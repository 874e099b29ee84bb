#include "mesher/lift_bad_quads.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/parallel.h"
#include "mesher/prepare.h"
#include "metrics/shape.h"
#include "smoothing/relocation/quad_relocation.h"
#include "smoothing/surface/surface_lift.h"
#include "smoothing/surface/surface_tracks.h"

namespace delquad {
namespace {

/// Quads below this eta in space are lifted, in so many sweeps.
constexpr double kPoorInSpace = 0.3;
constexpr int kLiftSweeps = 20;
/// Rings are put around what is bad so many times at most.
constexpr int kRingPasses = 3;

bool is_bad(const std::array<Vec3, 4>& corners) {
  return !(eta_of(element_shape(corners, area_vector(corners)).angle) > 0) || quad_warp(corners) > kFold;
}

/// The patches that take part.
std::vector<std::size_t> patches_of_quads(const AllPatches& in) {
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < in.patches.size(); ++i)
    if (in.patches[i].form == PatchForm::kQuads && !in.left_out[i]) which.push_back(i);
  return which;
}

/// Returns how many vertices moved.
int lift_all(const AllPatches& in, const std::vector<std::size_t>& which) {
  const PreparedSurface& surface = *in.prepared.surface;
  std::vector<SurfaceTracks::Patch> lifted;
  for (const std::size_t i : which)
    lifted.push_back({&surface.domain.patches[i], in.prepared.patches[i].cross.get(), &in.patches[i].quads,
                      &in.patches[i].inside});
  SurfaceTracks tracks(surface.model, *surface.size, surface.domain, in.nodes, std::move(lifted));
  std::vector<Vec3> places = tracks.points();
  const int moved = lift_worst_on_surface(tracks, places, kPoorInSpace, kLiftSweeps);
  if (moved > 0) tracks.store(places);
  return moved;
}

/// The bad quads of a patch, in space.
std::vector<int> bad_quads(const AllPatches& in, std::size_t patch) {
  const QuadPatch& mesh = in.patches[patch].quads;
  const std::vector<int>& node = in.prepared.patches[patch].boundary.point_node;
  const auto place = [&](int v) {
    const auto n = static_cast<int>(node.size());
    return v < n ? in.nodes.points[node[v]] : in.patches[patch].inside[v - n];
  };
  std::vector<int> bad;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& [a, b, c, d] = mesh.quads[q];
    if (is_bad({place(a), place(b), place(c), place(d)})) bad.push_back(static_cast<int>(q));
  }
  return bad;
}

using BadQuads = std::vector<std::pair<std::size_t, std::vector<int>>>;  // by patch

BadQuads all_bad_quads(const AllPatches& in, const std::vector<std::size_t>& which) {
  std::vector<std::vector<int>> bad(which.size());
  parallel_for(
      which.size(), [&](std::size_t k) { bad[k] = bad_quads(in, which[k]); },
      [&](std::size_t k) { return static_cast<double>(in.patches[which[k]].quads.quads.size()); });
  BadQuads found;
  for (std::size_t k = 0; k < which.size(); ++k)
    if (!bad[k].empty()) found.emplace_back(which[k], std::move(bad[k]));
  return found;
}

std::size_t count(const BadQuads& bad) {
  std::size_t n = 0;
  for (const auto& [patch, quads] : bad) n += quads.size();
  return n;
}

/// Puts a ring inside each of some quads of a patch; the new points follow the others, in space, too. Returns
/// how many rings.
int add_rings(const AllPatches& in, std::size_t p, const std::vector<int>& quads) {
  PatchMesh& patch = in.patches[p];
  QuadTopology mesh(patch.quads);
  QuadRelocation relocation(mesh, *in.prepared.patches[p].size);
  int rings = 0;
  for (const int q : quads) {
    const std::array<int, 1> quad{q};
    if (!mesh.can_pillow(quad)) continue;
    const int first = mesh.vertex_slots();
    mesh.pillow(quad);
    relocation.adopt_new_vertices(first);
    constexpr int kSweeps = 8;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int v = first; v < mesh.vertex_slots(); ++v) relocation.step(v);
    ++rings;
  }
  patch.quads = mesh.to_patch();
  const PreparedSurface& surface = *in.prepared.surface;
  const std::size_t n_boundary = in.prepared.patches[p].boundary.point_node.size();
  int hint = -1;
  for (std::size_t v = n_boundary + patch.inside.size(); v < patch.quads.points.size(); ++v)
    patch.inside.push_back(lift(surface.domain.patches[p], surface.model, patch.quads.points[v], hint));
  return rings;
}

}  // namespace

LiftingSummary lift_bad_quads(const AllPatches& in) {
  LiftingSummary summary;
  const std::vector<std::size_t> which = patches_of_quads(in);
  parallel_for(
      which.size(),
      [&](std::size_t k) {
        PatchMesh& patch = in.patches[which[k]];
        const DoingFace face = doing_patch(in.prepared, which[k]);
        if (patch.inside.empty()) patch.inside = places_inside(in.prepared, which[k], patch, in.nodes.points);
      },
      [&](std::size_t k) { return static_cast<double>(in.patches[which[k]].quads.points.size()); });
  summary.moved = lift_all(in, which);

  BadQuads bad = all_bad_quads(in, which);
  for (int pass = 0; pass < kRingPasses && !bad.empty(); ++pass) {
    std::vector<PatchMesh> patches;
    for (const std::size_t i : which) patches.push_back(in.patches[i]);
    const SurfaceNodes nodes = in.nodes;
    int rings = 0;
    for (const auto& [patch, quads] : bad) rings += add_rings(in, patch, quads);
    if (rings == 0) break;
    const int moved = lift_all(in, which);
    BadQuads left = all_bad_quads(in, which);
    if (count(left) >= count(bad)) {
      for (std::size_t k = 0; k < which.size(); ++k) in.patches[which[k]] = std::move(patches[k]);
      in.nodes = nodes;
      break;
    }
    summary.moved += moved;
    summary.rings += rings;
    bad = std::move(left);
  }
  return summary;
}

}  // namespace delquad
