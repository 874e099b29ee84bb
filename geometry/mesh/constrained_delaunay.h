// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header triangulates patches. Insertion, patches and curves use it.

namespace delquad {

/// Returns the constrained Delaunay triangulation of a patch by CGAL: the boundary's points, then `interior`
/// ones. Throws InputError if boundary edges cross or have the patch on both sides. It also throws if an
/// interior point lies outside, on the boundary or on another point.
TriPatch constrained_delaunay(const PatchBoundary& boundary, const std::vector<Vec2>& interior = {});

}  // namespace delquad
