#pragma once

#include <vector>

#include "patches/across_view.h"
#include "patches/curve_nodes.h"

namespace delquad {

/// Finds the curves that face each other along strips narrower than about the size. They want one and the
/// same number of edges, so that quads lie straight across. Returns for each curve the first of its group;
/// curves that face none are groups of their own.
std::vector<int> group_facing_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const AcrossView& across, const SizeOnLine& size);

}  // namespace delquad
