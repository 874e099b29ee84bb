#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// Adds seeds where single edges across a narrow place cannot be: a mesh of quads has an even number of edges
/// around either side of such an edge, but nodes that lie opposite each other may cut off an odd number. A
/// vertex halfway, and so two rows of quads instead of one, puts it right. In a sharp corner that is always
/// so: the one quad that fits into it has its fourth vertex inside.
void seed_narrow_places(PatchBoundary& boundary);

}  // namespace delquad
