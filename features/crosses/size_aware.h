// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "algorithms/fields/size_aware_cross_field.h"
#include "geometry/patches/meshing_setup.h"

// This header makes size-aware cross fields of all patches. The preparation uses it.

namespace delquad {

/// Replaces each patch's boundary-aligned field by the size-aware one, on a background mesh made for it: one
/// that follows delta', so that it resolves it. Notes singularities, sum of indices and dislocations.
/// `pull`: what they are drawn to besides, by patch; null: nothing.
using PatchPullAt = std::function<CrossPull(int patch, Vec2 u, int& hint)>;
void make_crosses_size_aware(MeshingSetup& prepared, const PatchPullAt& pull = nullptr);

/// Rows of quads that have to end along the fields of all patches so that sizes are as wanted, in the mean:
/// see expected_dislocations(). Takes about as long as D unless the fields are size-aware.
double expected_row_ends(const MeshingSetup& prepared);

}  // namespace delquad
