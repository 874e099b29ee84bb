#pragma once

#include "delquad/extend.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// The mirror image of a patch's mesh. `boundary`: that of the image, whose points stay.
PatchMesh image_of(const PatchMesh& master, const PatchBoundary& boundary, const PatchImage& image);

}  // namespace delquad
