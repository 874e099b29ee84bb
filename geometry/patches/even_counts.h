// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <vector>

#include "base/matching/edge_counts.h"
#include "base/matching/matching.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/surface_curves.h"

// This header chooses numbers of edges so that patches are even. Curves use it.

namespace delquad {

/// Returns n + 1 or n - 1: the allowed one nearer to the integral in ratio.
int changed_by_one(int n, const CurveDemand& curve);

/// Returns the cost of changed_by_one().
using ChangeCost = double (*)(int n, const CurveDemand& curve);
/// Returns |log((n +- 1) / n)|, times 4 for curves of one or two edges, whose sizes change most (own rule).
double cost_of_change(int n, const CurveDemand& curve);

/// Returns a number of edges near each curve's integral, such that each patch has an even boundary. The
/// curves to change by one are a minimum-weight T-join over patches and curves [edmonds1973], weighted by
/// `cost`. Odd patches are its terminals; curves of the outline lead to an outside of free parity. Curves of
/// more than two patches change first if the others are not enough. `odd_patches` gets the patches that stay
/// odd.
std::vector<int> even_counts(const std::vector<CurveDemand>& curves, int n_patches,
                             const MatchingSolver& solver, std::vector<int>& odd_patches,
                             ChangeCost cost = cost_of_change);

/// Cost of a size deviation of an edge, in eta: half of the weight in ElementQuality, since two quads share
/// an edge.
inline constexpr double kDeviationCost = 1.5 / 2;

/// Returns the sums that are zero if quads without irregular vertices can fill a patch (own conditions). A
/// corner turns by a right angle for each quad less than two. With these turns, the boundary of a disk must
/// come back to its beginning in the grid, along both axes. So must a hole with four concave corners, and
/// both loops of a ring must be equally long. Patches whose corners need irregular vertices have no sums,
/// since these vertices can avoid ends of rows.
std::vector<ClosureSum> closure_sums(const SurfaceCurves& curves, const CurveDemands& wanted);

/// Raises demands around small round holes, which need four irregular vertices beside each (own method). A
/// hole gets as many edges as the square around it, so that these vertices are at its corners. This needs
/// enough room, and a gain above the cost of sizes behind. `price` is as for agree_on_counts().
void widen_round_holes(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across, double price,
                       CurveDemands& wanted);

/// Changes numbers of edges so that fewer rows of quads must end, see agree_counts(). `price` >= 0 is the
/// worth of a removed irregular vertex, in quads times eta. Chains in `kept` keep their numbers.
void agree_on_counts(const SurfaceCurves& curves, const CurveDemands& wanted, double price,
                     const std::set<int>& kept, Budget& steps, std::vector<int>& counts);

}  // namespace delquad
