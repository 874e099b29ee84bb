#pragma once

#include <set>
#include <vector>

#include "base/matching/agree_counts.h"
#include "patches/surface_curves.h"

namespace delquad {

/// The sums that are zero around patches which quads without irregular vertices can fill. With the turns at
/// its corners (a right angle for each quad less than two), the boundary of a disk comes back to its
/// beginning in the grid, along both axes, and so does a hole with four concave corners; both loops of a ring
/// lead equally far. Patches whose corners make irregular vertices necessary have no sums: these find their
/// places so that rows need not end.
std::vector<ClosureSum> closure_sums(const SurfaceCurves& curves, const CurveDemands& wanted);

/// Lets numbers of edges agree, so that fewer rows of quads have to end, see agree_counts(). `price`: what an
/// irregular vertex less is worth, in quads times eta. Chains of `kept` keep their numbers.
void agree_on_counts(const Mesh& fine, const SurfaceCurves& curves, const CurveDemands& wanted,
                     const SurfaceSize& size, double price, const std::set<int>& kept, Budget& steps,
                     std::vector<int>& counts);

}  // namespace delquad
