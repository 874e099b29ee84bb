// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/fields.h"
#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

// This header makes sizes in narrow gaps. The composition of planar sizes uses it.

namespace delquad {

/// Returns the edges of curves that face others across a region within `rows` times the size. Beside each,
/// the size lets that many rows fit into the gap, but is at least a twentieth of the size before. Near a
/// corner between the curves there is no gap. Own method.
std::vector<LocalSize> gap_spots(const PlanarDomain& domain, const SizeField& size, double rows);

}  // namespace delquad
