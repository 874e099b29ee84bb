// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header triangulates patches. Insertion, patches and curves use it.

namespace delquad {

/// Makes the constrained Delaunay triangulation of a patch: the boundary's points, then `interior` ones;
/// nothing outside is kept. Throws InputError if boundary edges cross or have the patch on both sides. So it
/// does if an interior point lies outside, on the boundary or on another point.
TriPatch constrained_delaunay(const PatchBoundary& boundary, const std::vector<Vec2>& interior = {});

}  // namespace delquad
