// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/patches/meshing_setup.h"
#include "metrics/alignment.h"

// This header has the cross fields of all patches in space. Measures of alignment use it.

namespace delquad {

/// Returns the fields of all patches; null if the problem has a metric in place of sizes. `prepared` must
/// outlive them.
CrossInSpace cross_in_space(const MeshingSetup& prepared);

}  // namespace delquad
