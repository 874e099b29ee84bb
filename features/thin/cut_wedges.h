// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/planar/planar_model.h"

// This header cuts sharp corners off patches. The preparation of planar domains uses it.

namespace delquad {

/// Cuts sharp corners off patches where nodes face each other, as far as they are narrower than half an edge.
/// Their quads go to domain.boundary, see cap_corners(), and their nodes stay. Grids and mirror images keep
/// their corners. Own method.
void cut_wedges(PlanarDomain& domain);

}  // namespace delquad
