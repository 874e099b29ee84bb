#pragma once

#include "delquad/extend.h"
#include "geometry/planar/planar_model.h"
#include "patches/prepared.h"

namespace delquad {

/// The mirror image of a patch's mesh. `boundary`: that of the image, whose points stay.
PatchMesh image_of(const PatchMesh& master, const PatchBoundary& boundary, const PatchImage& image);

/// On the master's boundary the ends of edges at single points move; their images follow. `points`: of the
/// nodes of all boundaries.
void move_image_nodes(const PreparedProblem& prepared, const PatchImage& image, std::vector<Vec3>& points);

}  // namespace delquad
