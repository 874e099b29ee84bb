// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "geometry/patches/across_view.h"
#include "geometry/patches/curve_nodes.h"

// This header handles narrow strips of patches. Curves and the preparation use it.

namespace delquad {

/// Returns for each curve the first of its group: curves that face each other along strips narrower than
/// about the size (own rule). They want the same number of edges, so that quads lie straight across. Curves
/// that face none are alone in their group.
std::vector<int> group_facing_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const AcrossView& across, const SizeOnLine& size);

/// Adds seeds where a single edge across a narrow place is impossible (own method). Quads need an even number
/// of edges on both sides of such an edge, but opposite nodes may cut off an odd number. A seed halfway lets
/// two rows fit instead of one. A sharp corner always needs one, since its quad has its fourth vertex inside.
/// Places narrower than `least` edges get none.
void seed_narrow_places(PatchBoundary& boundary, double least = 0);

}  // namespace delquad
