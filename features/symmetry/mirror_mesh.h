#pragma once

#include <utility>
#include <vector>

#include "features/symmetry/mirrored_surface.h"

namespace delquad {

/// The image of a face of the whole at all planes whose bits are set.
int image_face(const MirroredSurface& mirrored, int planes, int face);

/// The faces that are marked, and all that are their images.
std::vector<char> with_images(const MirroredSurface& mirrored, std::vector<char> faces);

/// Adds the faces that are images of those that failed, for the same reasons.
void add_failures_of_images(const MirroredSurface& mirrored, std::vector<FaceFailure>& failures);

/// The mesh of the part, whose first points are the nodes on its curves, completed by its images: nodes on
/// planes, which are moved onto them to rounding, stand once, and so do elements in them. It has the curves,
/// faces and named points of the whole.
Mesh mirror_mesh(const MirroredSurface& mirrored, Mesh part);

}  // namespace delquad
