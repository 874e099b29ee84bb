// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "features/midsurface/body_rays.h"

// This header makes mid-surfaces of plates that join. Mid-surfaces of thin bodies use it.

namespace delquad {

/// Returns the mid-surfaces of plates as triangles with thickness, names and curves (own method). They share
/// nodes where plates join in the form of T, L, X or +.
///
/// Plates are faces that face each other in parallel, nearer than they are wide. All other faces are rims,
/// welds and fillets: they are left out. One side of each plate moves half-way to the other: the side whose
/// outline is known, then the one with the longer outline. The outline moves to the mid-planes of plates that
/// join there, also behind a weld. At a rim it moves to the end of the body. Plane plates are triangulated
/// anew, with the lines at which others meet them.
///
/// Returns nothing if no plates join and no rim is rounded. Throws InputError, with face and place, if a
/// thickness changes, a face is too wide for a rim or weld, or an outline crosses itself.
std::optional<Mesh> join_plates(const BodyRays& body);

}  // namespace delquad
