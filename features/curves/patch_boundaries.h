#pragma once

#include <optional>
#include <set>
#include <vector>

#include "base/budget.h"
#include "base/matching/matching.h"
#include "features/grids/grids.h"
#include "patches/surface_curves.h"

namespace delquad {

/// Nodes on the curves and the boundaries that they make in the patches' parameter planes.
struct PatchBoundaries {
  std::vector<int> counts;       ///< of each chain's edges
  std::vector<int> odd_patches;  ///< that no curve can make even
  SurfaceNodes nodes;
  std::vector<PatchBoundary> boundaries;
  std::vector<std::vector<int>> at_fault;  ///< of each patch, the curves that keep it from enclosing quads
};

/// How far numbers of edges agree, see agree_on_counts().
struct Agreement {
  double price = 0;         ///< 0: not at all
  std::set<int> kept = {};  ///< chains that have the numbers that their sizes ask for
};

/// Numbers of edges that make patches even, and the patches that stay odd.
struct ChainCounts {
  std::vector<int> counts, odd_patches;
};

/// `steps`: what agreement and the search for nodes that face each other may take. `mapped`: the patches that
/// are to be grids, as `spec` asks; see grid_counts(). `even`: those of the same demands, which depend on
/// nothing else; none: they are found, but where there are grids.
PatchBoundaries place_boundaries(const SurfaceModel& model, const SurfaceCurves& curves,
                                 const AcrossView& across, const CurveDemands& wanted,
                                 const SurfaceSize& size, const MatchingSolver& solver,
                                 const MappedSpec& spec, const Agreement& agreement, Budget& steps,
                                 std::vector<MappedFace>& mapped, std::optional<ChainCounts>& even);

}  // namespace delquad
