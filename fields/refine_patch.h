#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// A triangulation of the patch with few small angles, as coarse as its boundary edges allow, which may be
/// split. The boundary's points first, in their order. Throws InputError where the boundary crosses itself.
TriPatch refine_patch(const PatchBoundary& patch);

}  // namespace delquad
