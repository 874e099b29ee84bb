#pragma once

#include <vector>

#include "base/matching/matching.h"
#include "patches/curve_nodes.h"

namespace delquad {

/// n + 1 or n - 1, whichever is nearer to the integral in ratio and allowed.
int changed_by_one(int n, const CurveDemand& curve);

/// What it costs to change n so.
using ChangeCost = double (*)(int n, const CurveDemand& curve);
/// |log((n +- 1) / n)|, more for curves of one or two edges, which splitting distorts most.
double cost_of_change(int n, const CurveDemand& curve);

/// Rounds every curve's integral to a number of edges so that each patch is bounded by an even number of
/// them. The curves to change by one are a minimum-weight T-join over patches and curves (odd patches are the
/// terminals; the curves of the outline lead to an outside whose parity is free), weighted by `cost`. Curves
/// at which more than two patches meet are changed before, where the others cannot do it alone. `odd_patches`
/// receives the patches for which there is none.
std::vector<int> even_counts(const std::vector<CurveDemand>& curves, int n_patches,
                             const MatchingSolver& solver, std::vector<int>& odd_patches,
                             ChangeCost cost = cost_of_change);

}  // namespace delquad
