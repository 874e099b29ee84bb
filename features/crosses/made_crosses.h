// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/fields.h"
#include "geometry/patches/meshing_setup.h"

// This header makes cross fields by a maker from outside. The preparation uses it.

namespace delquad {

/// Replaces each patch's field by the field of the spec's maker. Known singularities are dropped. Throws
/// InputError, beginning with spec.where, if the maker returns no field or the field returns no cross, and
/// passes on its exceptions.
void use_made_crosses(const CrossSpec& spec, MeshingSetup& prepared);

}  // namespace delquad
