// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/planar/planar_model.h"

// This header cuts sharp corners off patches. The preparation of planar domains uses it.

namespace delquad {

/// Takes sharp corners out of patches that stages mesh, where nodes face each other, as far as they are
/// narrower than half an edge. Their quads go to domain.boundary, see cap_corners(), and their nodes stay.
void cut_wedges(PlanarDomain& domain);

}  // namespace delquad
