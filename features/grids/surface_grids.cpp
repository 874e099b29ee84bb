// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/grids/grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// The loops of all patches.
std::vector<FaceOutline> outlines_of(const Mesh& fine, const SurfaceCurves& curves,
                                     const CurveDemands& wanted) {
  std::vector<FaceOutline> outlines(curves.maps.size());
  std::size_t corner = 0;  // in the same order
  for (std::size_t p = 0; p < outlines.size(); ++p)
    for (const auto& sides : curves.outlines[p]) {
      auto& loop = outlines[p].emplace_back();
      for (const CurveSide& side : sides) {
        const CurveChain& chain = curves.chains[side.chain];
        if (!side.begins(chain)) continue;
        const int node = side.forward ? chain.points.front() : chain.points.back();
        const CurveDemand& demand = wanted.demands[side.chain];
        loop.push_back({side.chain, node, fine.points[node], curves.corners[corner++].angle,
                        demand.exact > 0 ? demand.exact : demand.integral});
      }
    }
  return outlines;
}

std::string chain_label(const Mesh& fine, const CurveChain& chain) {
  const Entity& curve = fine.curves[chain.curve];
  return curve.names.empty() ? fmt::format("curve_{}", curve.tag) : curve.names[0];
}

}  // namespace

std::vector<MappedFace> find_surface_grids(const MappedSpec& spec, const Mesh& fine,
                                           const SurfaceCurves& curves, const CurveDemands& wanted) {
  GridFinder::NamedPlaces points;
  for (const NamedPoint& named : fine.named_points)
    for (const std::string& name : named.entity.names) points.emplace_back(name, fine.points[named.point]);
  GridFinder finder(spec, fine.regions, points);
  const std::vector<FaceOutline> outlines = outlines_of(fine, curves, wanted);
  std::vector<int> n_patches(fine.regions.size(), 0);
  for (const FlatPatch& map : curves.maps) ++n_patches[map.face];
  std::vector<MappedFace> mapped;
  for (std::size_t p = 0; p < outlines.size(); ++p) {
    const Entity& region = fine.regions[curves.maps[p].face];
    const auto found = finder.find(static_cast<int>(p), region, outlines[p], wanted.quads[p]);
    if (!found) continue;
    if (found->is_requested && n_patches[curves.maps[p].face] > 1 &&
        std::ranges::count(curves.cut_face, curves.maps[p].face) > 0)
      throw InputError(
          fmt::format("{}: '{}' cannot be a grid: it had to be divided into {} parts to be "
                      "flattened [no-grid]",
                      spec.where, region_label(region), n_patches[curves.maps[p].face]));
    mapped.push_back(*found);
  }
  finder.finish();
  return mapped;
}

std::vector<int> grid_counts(const MappedSpec& spec, const Mesh& fine, const SurfaceCurves& curves,
                             const CurveDemands& wanted, std::vector<MappedFace>& mapped,
                             std::vector<int>& odd_patches) {
  const std::vector<int> leader = leaders(curves);
  const std::vector<CurveDemand> demands = joined_demands(wanted.demands, curves.images);
  std::vector<CountedCurve> counted;
  std::vector<std::vector<int>> around(curves.maps.size());
  for (std::size_t c = 0; c < demands.size(); ++c) {
    const CurveDemand& demand = demands[c];
    const int n = demand.exact > 0 ? demand.exact
                                   : std::max(demand.minimum, static_cast<int>(std::lround(demand.integral)));
    const bool follows = leader[c] != static_cast<int>(c);
    counted.push_back({std::max(demand.integral, 1e-3), n, demand.minimum, demand.exact == 0 && !follows});
    for (const int p : wanted.demands[c].patches) around[p].push_back(leader[c]);
  }
  const auto bad = balance_grids(counted, around, leader, mapped);
  odd_patches.clear();
  for (const UnbalancedFace& face : bad) {
    const auto grid = std::ranges::find(mapped, face.face, &MappedFace::face);
    if (grid == mapped.end()) {
      odd_patches.push_back(face.face);
      continue;
    }
    std::vector<std::string> names;
    for (const CurveChain& chain : curves.chains) names.push_back(chain_label(fine, chain));
    throw InputError(fmt::format("{}: {}", spec.where,
                                 why_unbalanced(face, region_label(fine.regions[curves.maps[face.face].face]),
                                                &*grid, counted, names)));
  }
  std::vector<int> counts;
  for (std::size_t c = 0; c < counted.size(); ++c) counts.push_back(counted[leader[c]].n);
  return counts;
}

bool is_balanced(const MappedFace& face, const std::vector<int>& counts) {
  std::vector<int> n;
  for (const auto& side : face.sides) {
    n.push_back(0);
    for (const int c : side) n.back() += counts[c];
  }
  return n.size() == 4 ? n[0] == n[2] && n[1] == n[3] : n.size() == 2 && n[0] == n[1];
}

std::vector<MappedPatch> grid_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                      const std::vector<int>& counts) {
  std::vector<MappedPatch> patches;
  for (const MappedFace& face : mapped) {
    MappedPatch& patch = patches.emplace_back(MappedPatch{face.face, {}, face.is_requested, face.rows});
    if (face.begins.empty()) continue;
    std::size_t part = 0;
    int at = 0;
    for (const CurveSide& side : curves.outlines[face.face][0]) {
      if (!side.begins(curves.chains[side.chain])) continue;
      if (std::ranges::find(face.begins, part++) != face.begins.end()) patch.corners.push_back(at);
      at += counts[side.chain];
    }
  }
  return patches;
}

}  // namespace delquad
