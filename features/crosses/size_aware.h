// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "algorithms/fields/size_aware_cross_field.h"
#include "geometry/patches/meshing_setup.h"

// This header makes size-aware cross fields of all patches. The preparation uses it.

namespace delquad {

/// Returns the direction that the field of a patch is drawn to at u, with its strength. `hint` is as in
/// SizeField::at.
using PatchPullAt = std::function<CrossPull(int patch, Vec2 u, int& hint)>;
/// Replaces the boundary-aligned field of each patch by the size-aware one, on a background mesh that
/// resolves delta'. A patch without a field first gets the harmonic one of its boundary's triangulation.
/// Stores singularities, the sum of indices and dislocations. A null `pull` draws to nothing. Own method
/// (docs/algorithms.md, cross field).
void make_crosses_size_aware(MeshingSetup& prepared, const PatchPullAt& pull = nullptr);

/// Returns the expected number of rows of quads that must end along the fields of all patches to keep the
/// sizes, see expected_dislocations(). It takes about as long as stage D unless the fields are size-aware.
/// Own method.
double expected_row_ends(const MeshingSetup& prepared);

}  // namespace delquad
