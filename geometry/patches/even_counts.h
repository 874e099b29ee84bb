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

/// Returns n + 1 or n - 1, whichever is nearer to the integral in ratio and allowed.
int changed_by_one(int n, const CurveDemand& curve);

/// The cost of changing n so.
using ChangeCost = double (*)(int n, const CurveDemand& curve);
/// Returns |log((n +- 1) / n)|, more for curves of one or two edges, which splitting distorts most.
double cost_of_change(int n, const CurveDemand& curve);

/// Rounds every curve's integral to a number of edges so that each patch is bounded by an even number of
/// them. The curves to change by one are a minimum-weight T-join over patches and curves, weighted by `cost`.
/// Odd patches are its terminals; curves of the outline lead to an outside whose parity is free. Curves at
/// which more than two patches meet are changed before, where the others cannot do it alone. `odd_patches`
/// receives the patches for which there is none.
std::vector<int> even_counts(const std::vector<CurveDemand>& curves, int n_patches,
                             const MatchingSolver& solver, std::vector<int>& odd_patches,
                             ChangeCost cost = cost_of_change);

/// The cost, against eta, of edges whose length differs from the size. It is half of the weight in
/// QuadRelocation: two quads share an edge.
inline constexpr double kDeviationCost = 1.5 / 2;

/// Returns the sums that are zero around patches which quads without irregular vertices can fill. They use
/// the turns at corners: a right angle for each quad less than two. With these turns, the boundary of a disk
/// comes back to its beginning in the grid, along both axes. So does a hole with four concave corners, and
/// both loops of a ring lead equally far. Patches whose corners make irregular vertices necessary have no
/// sums: these find their places so that rows need not end.
std::vector<ClosureSum> closure_sums(const SurfaceCurves& curves, const CurveDemands& wanted);

/// Asks for more edges around small round holes in faces that need four irregular vertices beside each. It
/// asks for as many as around a square that encloses the hole, so that these vertices stand at its corners.
/// It does so where there is room, and where that is worth more than the sizes of the quads behind. `price`:
/// as for agree_on_counts().
void widen_round_holes(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across, double price,
                       CurveDemands& wanted);

/// Lets numbers of edges agree, so that fewer rows of quads have to end, see agree_counts(). `price`: what an
/// irregular vertex less is worth, in quads times eta. Chains of `kept` keep their numbers.
void agree_on_counts(const SurfaceCurves& curves, const CurveDemands& wanted, double price,
                     const std::set<int>& kept, Budget& steps, std::vector<int>& counts);

}  // namespace delquad
