// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "geometry/patches/places_inside.h"
#include "smoothing/surface/surface_lift.h"

// This header edits quads that fail criteria. Repairs of quads in space use it.

namespace delquad {

/// Edits the quads of a patch (by index) around quads that fail in space (own method). Edits are rotations,
/// collapses, openings and splits; the best one must leave fewer failing quads after relocation at a small
/// loss of eta. Boundary nodes stay. Returns the number of edits.
int edit_failing(const AllPatches& in, std::size_t patch, const SpaceLimits& limits);

}  // namespace delquad
