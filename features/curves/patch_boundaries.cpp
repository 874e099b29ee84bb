#include "features/curves/patch_boundaries.h"

#include <utility>

#include "base/box_tree.h"
#include "base/predicates.h"
#include "features/periodic/periodic.h"
#include "patches/agreeing_counts.h"
#include "patches/even_counts.h"
#include "patches/face_nodes.h"

namespace delquad {

namespace {

/// Pairs of edges that share a point other than a common end.
std::vector<std::pair<size_t, size_t>> crossing_edges(const PatchBoundary& boundary) {
  const auto& p = boundary.points;
  std::vector<Box<Vec2>> boxes;
  for (const auto& [a, b] : boundary.edges) boxes.push_back(Box<Vec2>::around({p[a], p[b]}));
  const BoxTree<Vec2> tree(boxes);
  std::vector<std::pair<size_t, size_t>> pairs;
  for (size_t i = 0; i < boundary.edges.size(); ++i) {
    const auto [a, b] = boundary.edges[i];
    const auto gap = [&](const BoxTree<Vec2>::Node& node) { return boxes[i].overlaps(node.box) ? 0 : 1; };
    tree.search(0.0, gap, [&](int item) {
      const auto j = static_cast<size_t>(item);
      const auto [c, d] = boundary.edges[j];
      if (j >= i || !boxes[i].overlaps(boxes[j]) || a == c || a == d || b == c || b == d) return;
      if (orient2d(p[a], p[b], p[c]) * orient2d(p[a], p[b], p[d]) <= 0 &&
          orient2d(p[c], p[d], p[a]) * orient2d(p[c], p[d], p[b]) <= 0)
        pairs.emplace_back(i, j);
    });
  }
  return pairs;
}

/// The curves that keep the boundary from enclosing quads; empty if none do.
std::vector<int> curves_at_fault(const PatchBoundary& boundary, const std::vector<int>& chain_of_edge,
                                 const PatchOutline& outline) {
  std::vector<int> curves;
  size_t first = 0;
  for (const auto& loop : outline) {
    size_t end = first + 1;
    while (boundary.edges[end - 1][1] != static_cast<int>(first)) ++end;
    if (end - first < kFewestLoopEdges)
      for (const CurveSide& s : loop) curves.push_back(s.chain);
    first = end;
  }
  if (!curves.empty() || meshable(boundary)) return curves;
  for (const auto& [i, j] : crossing_edges(boundary)) {
    curves.push_back(chain_of_edge[i]);
    curves.push_back(chain_of_edge[j]);
  }
  if (curves.empty()) curves = chain_of_edge;  // coincident points, or turned inside out
  return curves;
}

}  // namespace

PatchBoundaries place_boundaries(const SurfaceModel& model, const SurfaceCurves& curves,
                                 const AcrossView& across, const CurveDemands& wanted,
                                 const SurfaceSize& size, const MatchingSolver& solver,
                                 const MappedSpec& spec, const Agreement& agreement, Budget& steps,
                                 std::vector<MappedFace>& mapped, std::optional<ChainCounts>& even) {
  const std::vector<FlatPatch>& maps = curves.maps;
  PatchBoundaries placed;
  if (!mapped.empty()) {
    placed.counts = grid_counts(spec, model.fine, curves, wanted, mapped, placed.odd_patches);
  } else {
    if (!even) {
      even.emplace();
      even->counts = even_counts(joined_demands(wanted.demands, curves.images), static_cast<int>(maps.size()),
                                 solver, even->odd_patches);
    }
    placed.counts = even->counts;
    placed.odd_patches = even->odd_patches;
  }
  if (agreement.price > 0) {
    std::set<int> kept = agreement.kept;
    for (const MappedFace& face : mapped)
      for (const auto& side : face.sides) kept.insert(side.begin(), side.end());
    agree_on_counts(model.fine, curves, wanted, size, agreement.price, kept, steps, placed.counts);
  }
  for (const ChainPair& pair : curves.images) placed.counts[pair.chain] = placed.counts[pair.master];
  CurvePlaces places = face_nodes(model.fine, curves.chains, across, wanted.integrals, placed.counts,
                                  wanted.group, size_on_lines(size), steps);
  for (std::size_t c = 0; c < wanted.divided.size(); ++c)
    for (std::size_t k = 0; k < wanted.divided[c].size(); ++k)
      places[c][k] = placed.counts[c] * wanted.integrals[c].part_at(wanted.divided[c][k]);
  place_as_masters(model.fine, curves, wanted.integrals, places);
  placed.nodes = place_nodes(model, curves.chains, curves.cut_face, wanted.integrals, places);
  place_images(model, curves, placed.nodes);
  placed.boundaries.resize(maps.size());
  placed.at_fault.resize(maps.size());
  for_each_patch(model.fine, maps, [&](size_t p) {
    std::vector<int> chain_of_edge;
    placed.boundaries[p] =
        place_boundary(maps[p], curves.outlines[p], curves.chains, placed.nodes, &chain_of_edge);
    placed.at_fault[p] = curves_at_fault(placed.boundaries[p], chain_of_edge, curves.outlines[p]);
  });
  return placed;
}

}  // namespace delquad
