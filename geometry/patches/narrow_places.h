// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "geometry/patches/across_view.h"
#include "geometry/patches/curve_nodes.h"

// This header handles narrow strips of patches. Curves and the preparation use it.

namespace delquad {

/// Finds the curves that face each other along strips narrower than about the size. They want one and the
/// same number of edges, so that quads lie straight across. Returns for each curve the first of its group;
/// curves that face none are groups of their own.
std::vector<int> group_facing_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const AcrossView& across, const SizeOnLine& size);

/// Adds seeds where single edges across a narrow place cannot be. A mesh of quads has an even number of edges
/// around either side of such an edge. Nodes that lie opposite each other may cut off an odd number. A vertex
/// halfway, and so two rows of quads instead of one, puts it right. In a sharp corner that is always
/// so: the one quad that fits into it has its fourth vertex inside. Places narrower than `least` edges stay
/// whole.
void seed_narrow_places(PatchBoundary& boundary, double least = 0);

}  // namespace delquad
