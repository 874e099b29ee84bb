// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/fields.h"
#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Edges of curves that face others across a region nearer than `rows` times the size: beside each the size
/// is that of a gap which holds so many rows, though no less than a twentieth of what it was. Near a corner
/// between the curves there is no gap.
std::vector<LocalSize> gap_spots(const PlanarDomain& domain, const SizeField& size, double rows);

}  // namespace delquad
