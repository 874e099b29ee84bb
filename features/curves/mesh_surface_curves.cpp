// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_surface_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "base/activity.h"
#include "base/box_tree.h"
#include "base/budget.h"
#include "base/predicates.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/divisions/divisions.h"
#include "features/grids/grids.h"
#include "geometry/patches/across_view.h"
#include "geometry/patches/boundary_cap.h"
#include "geometry/patches/even_counts.h"
#include "geometry/patches/narrow_places.h"
#include "geometry/patches/surface_curves.h"

namespace delquad {

namespace {

/// Nodes on the curves and the boundaries that they make in the patches' parameter planes.
struct PatchBoundaries {
  std::vector<int> counts;       ///< of each chain's edges
  std::vector<int> odd_patches;  ///< that no curve can make even
  SurfaceNodes nodes;
  std::vector<PatchBoundary> boundaries;
  std::vector<std::vector<int>> at_fault;  ///< of each patch, the curves that keep it from enclosing quads
};

/// Numbers of edges that make patches even, and the patches that stay odd.
struct ChainCounts {
  std::vector<int> counts, odd_patches;
};

/// How far numbers of edges agree, see agree_on_counts().
struct Agreement {
  double price = 0;         ///< 0: not at all
  std::set<int> kept = {};  ///< chains that have the numbers that their sizes ask for
};

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

/// `steps`: what agreement and the search for nodes that face each other may take. `mapped`: the patches that
/// are to be grids, as `spec` asks; see grid_counts(). `even`: even counts of the same demands, which depend
/// on nothing else; none: they are found, but where there are grids.
PatchBoundaries place_boundaries(const SurfaceModel& model, const SurfaceCurves& curves,
                                 const AcrossView& across, const CurveDemands& wanted,
                                 const SurfaceSize& size, const MatchingSolver& solver,
                                 const MappedSpec& spec, const Agreement& agreement, Budget& steps,
                                 std::vector<MappedFace>& mapped, std::optional<ChainCounts>& even) {
  const std::vector<FlatPatch>& maps = curves.maps;
  PatchBoundaries placed;
  if (!mapped.empty())
    placed.counts = grid_counts(spec, model.fine, curves, wanted, mapped, placed.odd_patches);
  if (mapped.empty()) {
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
    agree_on_counts(curves, wanted, agreement.price, kept, steps, placed.counts);
  }
  for (const ChainPair& pair : curves.images) placed.counts[pair.chain] = placed.counts[pair.master];
  CurvePlaces places = align_opposite_nodes(model.fine, curves.chains, across, wanted.integrals,
                                            placed.counts, wanted.group, size_on_lines(size), steps);
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

/// So many times curves are refined to keep boundary polygons from crossing.
constexpr int kRefinements = 8;
/// And no more once all curves have so many edges, which takes a second for each time.
constexpr long long kMostEdges = 1'000'000;
/// So many times curves that keep boundaries from enclosing quads leave agreement.
constexpr int kMostKept = 10;
/// Steps of agreement: so many, and so many for each quad.
constexpr double kLeastAgreement = 1e6, kAgreementPerQuad = 1e4;
/// With curves.thin = "rows" narrower places keep one row, in edges: two would be thinner than sheets allow.
constexpr double kLeastSplit = 0.66;
/// Where a patch is narrowest between these chains, and how wide: the least height of triangles with all
/// corners on them; empty: there are none.
std::string narrowest_between(const Mesh& fine, const FlatPatch& map, const std::vector<CurveChain>& chains,
                              const std::vector<int>& at_fault) {
  std::set<int> on_chains;
  for (const int c : at_fault) on_chains.insert(chains[c].points.begin(), chains[c].points.end());
  double width = std::numeric_limits<double>::infinity();
  Vec3 at;
  for (const auto& triangle : map.flat.triangles) {
    std::array<Vec3, 3> x;
    bool is_between = true;
    for (int k = 0; k < 3; ++k) {
      const int node = map.fine_node[triangle[k]];
      x[k] = fine.points[node];
      is_between &= on_chains.contains(node);
    }
    const double longest = std::max({norm(x[1] - x[0]), norm(x[2] - x[1]), norm(x[0] - x[2])});
    const double height = norm(cross(x[1] - x[0], x[2] - x[0])) / longest;
    if (is_between && height < width) width = height, at = (1.0 / 3) * (x[0] + x[1] + x[2]);
  }
  return std::isfinite(width) ? fmt::format(
                                    "; it is {:.3g} wide at {}: --ignore-below {:.3g} leaves narrower "
                                    "places out",
                                    width, show_point(at), 2 * width)
                              : "";
}

/// The curves that keep boundaries from enclosing quads do not take part in agreement, then get more edges,
/// until there are none.
PatchBoundaries place_sound_boundaries(const SurfaceModel& model, const SurfaceCurves& curves,
                                       const AcrossView& across, CurveDemands& wanted,
                                       const SurfaceSize& size, const MatchingSolver& solver,
                                       const MappedSpec& spec, double price, Budget& steps,
                                       std::vector<MappedFace>& mapped) {
  Agreement agreement{price};
  std::optional<ChainCounts> even;
  for (int attempt = 0, kept = 0;;) {
    PatchBoundaries placed =
        place_boundaries(model, curves, across, wanted, size, solver, spec, agreement, steps, mapped, even);
    const std::size_t n_kept = agreement.kept.size();
    if (price > 0 && kept++ < kMostKept)
      for (const std::vector<int>& at_fault : placed.at_fault)
        agreement.kept.insert(at_fault.begin(), at_fault.end());
    if (agreement.kept.size() > n_kept) continue;
    const FlatPatch* crossing = nullptr;
    const std::vector<int>* at_fault = nullptr;
    bool can_change = false;
    for (size_t p = 0; p < curves.maps.size(); ++p) {
      if (!placed.at_fault[p].empty()) crossing = &curves.maps[p], at_fault = &placed.at_fault[p];
      for (const int c : placed.at_fault[p]) wanted.demands[c].minimum = 2 * placed.counts[c];
      can_change |=
          std::ranges::any_of(placed.at_fault[p], [&](int c) { return wanted.demands[c].exact == 0; });
    }
    if (crossing == nullptr) return placed;
    even.reset();
    const long long edges = std::accumulate(placed.counts.begin(), placed.counts.end(), 0LL);
    if (attempt++ == kRefinements || !can_change || (attempt > 1 && edges > kMostEdges))
      throw FaceError(
          crossing->face,
          fmt::format("{}: its boundary crosses itself in the parameter plane {}{}",
                      face_name(model.fine, *crossing),
                      can_change ? "however fine its curves are" : "with the edges that its curves are given",
                      narrowest_between(model.fine, *crossing, curves.chains, *at_fault)));
  }
}

Warning warn_of_spent_steps() {
  return {"steps that were stopped before their end", 0,
          "the search for better numbers and places of nodes on curves has used up its work. Some vertices "
          "may be irregular without need; wider faces or a larger size help [search-stopped]"};
}

/// Gives the second lips of cracks the nodes of the first ones.
void pair_lips(const SurfaceModel& model, SurfaceCurves& curves) {
  const auto chains_of = [&](int curve) {
    std::vector<int> chains;
    for (std::size_t c = 0; c < curves.chains.size(); ++c)
      if (curves.chains[c].curve == curve) chains.push_back(static_cast<int>(c));
    return chains;
  };
  for (const auto& [crack, lip] : model.lips) {
    const std::vector<int> masters = chains_of(crack), chains = chains_of(lip);
    assert(masters.size() == chains.size());
    for (std::size_t k = 0; k < chains.size(); ++k)
      curves.images.push_back({chains[k], masters[k], true, {}});
  }
}

/// Takes pointed tips and sharp corners out of patches, and the nodes that this drops from their curves.
class Capping {
 public:
  Capping(const SurfaceModel& model, const SurfaceCurves& curves, const std::vector<CurveDemand>& demands,
          const std::vector<char>& is_layered, SurfaceDomain& domain)
      : model_(model), curves_(curves), demands_(demands), is_layered_(is_layered), domain_(domain) {}

  /// Caps that leave no area are not made, as where two boundaries are nearer than an edge. Nor are caps that
  /// take nodes of periodic curves away.
  void cap(int p) {
    SurfacePatch& patch = domain_.patches[p];
    const PatchBoundary before = patch.boundary;
    const std::size_t n_points = domain_.nodes.points.size();
    for (const bool tips : {true, false}) {
      const std::vector<BoundaryCap> caps = find(p, patch, tips);
      if (!caps.empty() && (drop_paired(caps) || !meshable(patch.boundary))) {
        patch.boundary = before;
        domain_.nodes.points.resize(n_points);
        continue;
      }
      for (const BoundaryCap& cap : caps) accept(p, cap);
      return;
    }
  }

 private:
  /// Nodes of a patch where two curves without layers meet that have it on one side only.
  std::set<int> corners_to_cut(int p) const {
    const auto stays = [&](int chain) {
      return (!is_layered_.empty() && is_layered_[curves_.chains[chain].curve] != 0) ||
             std::ranges::count(demands_[chain].patches, p) > 1;
    };
    std::set<int> found;
    for (const FaceCorner& c : curves_.corners) {
      if (c.patch != p || stays(c.before) || stays(c.after)) continue;
      const auto& on_curve = domain_.nodes.on_curve[c.after];
      found.insert((c.after_ends ? on_curve.back() : on_curve.front()).node);
    }
    return found;
  }

  std::vector<BoundaryCap> find(int p, SurfacePatch& patch, bool tips) {
    SurfaceNodes& nodes = domain_.nodes;
    const auto add = [&](const Vec3& x) {
      nodes.points.push_back(x);
      return static_cast<int>(nodes.points.size()) - 1;
    };
    int hint = -1;
    std::vector<BoundaryCap> caps;
    if (tips) caps = cap_tips(patch.boundary, [&](Vec2 u) { return add(lift(patch, model_, u, hint)); });
    const std::set<int> corners = corners_to_cut(p);
    const CapNodes cap_nodes{[&](int node) { return corners.contains(node); },
                             [&](int node) { return nodes.points[node]; },
                             [&](const Vec3& x, Vec2 u) {
                               return model_.projector ? model_.projector->to_face(patch.map.face, x)
                                                       : lift(patch, model_, u, hint);
                             },
                             [&](Vec2 u) { return fine_normal(patch, model_.fine, u, hint); }, add};
    for (BoundaryCap& cap : cap_corners(patch.boundary, cap_nodes)) caps.push_back(std::move(cap));
    return caps;
  }

  /// Whether caps take nodes away that are images or have them.
  bool drop_paired(const std::vector<BoundaryCap>& caps) const {
    const auto is_dropped = [&](const CurveNode& n) {
      return std::ranges::any_of(caps, [&](const BoundaryCap& cap) {
        return std::ranges::find(cap.dropped, n.node) != cap.dropped.end();
      });
    };
    return std::ranges::any_of(curves_.images, [&](const ChainPair& pair) {
      return std::ranges::any_of(domain_.nodes.on_curve[pair.chain], is_dropped) ||
             std::ranges::any_of(domain_.nodes.on_curve[pair.master], is_dropped);
    });
  }

  void accept(int p, const BoundaryCap& cap) {
    for (auto& on_curve : domain_.nodes.on_curve)
      std::erase_if(on_curve, [&](const CurveNode& n) {
        return std::ranges::find(cap.dropped, n.node) != cap.dropped.end();
      });
    domain_.caps.push_back({p, cap});
  }

  const SurfaceModel& model_;
  const SurfaceCurves& curves_;
  const std::vector<CurveDemand>& demands_;
  const std::vector<char>& is_layered_;
  SurfaceDomain& domain_;
};

}  // namespace

SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                                  const MatchingSolver& solver, const SizeField* asked,
                                  const std::vector<CurveDivision>& divisions, const PeriodicSides& periodic,
                                  const MappedSpec& mapped, const CurveAgreement& agreement,
                                  const std::vector<char>& is_layered) {
  const Mesh& fine = model.fine;
  SurfaceCurves curves = find_curves(model, std::move(flattening), size.on_maps());
  ChainPairs pairs = pair_chains(model, curves.chains, curves.cut_face, periodic);
  curves.images = std::move(pairs.pairs);
  const AcrossView across(fine, curves.chains, curves.maps, curves.outlines);
  CurveDemands wanted = measure_curves(fine, curves, across, size, asked != nullptr ? *asked : size);
  if (agreement.round_holes) widen_round_holes(fine, curves, across, agreement.price, wanted);
  for (std::size_t c = 0; c < wanted.demands.size(); ++c)
    wanted.demands[c].most = most_edges(wanted.lengths[c], agreement.shortest);
  divide_curves(fine, curves, divisions, wanted);
  pair_lips(model, curves);
  SurfaceDomain domain;
  domain.warnings = warn_of_short_curves(fine, curves.chains, wanted);
  std::vector<MappedFace> grids;
  if (mapped.asks() || agreement.narrow_grids) grids = find_surface_grids(mapped, fine, curves, wanted);
  const double quads = std::accumulate(wanted.quads.begin(), wanted.quads.end(), 0.0);
  const long long most_steps =
      std::min(agreement.most_steps, static_cast<long long>(kLeastAgreement + kAgreementPerQuad * quads));
  Budget steps(most_steps);
  PatchBoundaries placed = place_sound_boundaries(model, curves, across, wanted, size, solver, mapped,
                                                  agreement.price, steps, grids);
  domain.steps = most_steps - steps.left();
  if (steps.is_spent()) domain.warnings.push_back(warn_of_spent_steps());
  if (agreement.price > 0)
    for (MappedFace& face : find_surface_grids({}, fine, curves, wanted))
      if (is_balanced(face, placed.counts) &&
          std::ranges::find(grids, face.face, &MappedFace::face) == grids.end())
        grids.push_back(std::move(face));
  domain.mapped = grid_patches(grids, curves, placed.counts);
  if (!divisions.empty())
    check_divisions_even(divisions[0].where + ": ", fine, curves, wanted, placed.odd_patches);
  for (const int p : placed.odd_patches)
    domain.warnings.push_back({"faces with an odd boundary that no curve can make even", 0,
                               face_name(fine, curves.maps[p]) +
                                   " has an odd boundary that no curve can make even: one triangle is left"});

  std::vector<std::shared_ptr<BackgroundMesh>> backgrounds(curves.maps.size());
  for_each_patch(fine, curves.maps,
                 [&](size_t p) { backgrounds[p] = std::make_shared<BackgroundMesh>(curves.maps[p].flat); });
  domain.nodes = std::move(placed.nodes);
  domain.sharp_corners =
      find_sharp_corners(curves.corners, curves.chains, curves.maps, domain.nodes, kBadEta);
  Capping capping(model, curves, wanted.demands, is_layered, domain);
  for (size_t p = 0; p < curves.maps.size(); ++p) {
    domain.patches.push_back({std::move(curves.maps[p]), std::move(curves.outlines[p]),
                              std::move(placed.boundaries[p]), std::move(backgrounds[p]),
                              std::move(curves.tube_sizes[p])});
    SurfacePatch& patch = domain.patches[p];
    if (std::ranges::find(grids, static_cast<int>(p), &MappedFace::face) != grids.end()) continue;
    const FaceScope face(fine.regions[patch.map.face].tag);
    try {
      capping.cap(static_cast<int>(p));
      seed_narrow_places(patch.boundary, agreement.thin_rows ? kLeastSplit : 0);
    } catch (const InputError& error) {
      throw FaceError(patch.map.face, fmt::format("{}: {}", face_name(fine, patch.map), error.what()));
    }
  }
  if (!divisions.empty()) warn_of_lost_nodes(fine, curves, wanted, divisions, domain);
  domain.boundary = boundary_mesh(fine, curves.chains, domain.nodes);
  add_pairs(curves, periodic, pairs.of_sides, domain);
  std::erase_if(domain.boundary.periodic, [&](const PeriodicNodes& p) {
    return std::ranges::find(model.lips, std::array{p.master, p.curve}) != model.lips.end();
  });
  domain.chains = std::move(curves.chains);
  for (const auto& places : wanted.divided) domain.chain_stays.push_back(!places.empty());
  for (const ChainPair& pair : curves.images)
    domain.chain_stays[pair.chain] = domain.chain_stays[pair.master] = 1;
  domain.cut_face = std::move(curves.cut_face);
  return domain;
}

}  // namespace delquad
