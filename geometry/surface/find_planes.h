#pragma once

#include <vector>

#include "geometry/surface/mirror_match.h"

namespace delquad {

/// The planes at which a model is symmetric, perpendicular to each other; none where none are found. They go
/// through the middle of the model or the centroid of its surface. Of those that are equally good, the ones
/// that are perpendicular to x, y and z come first.
std::vector<SymmetryPlane> find_symmetry_planes(const SurfaceModel& model, const MirrorMatcher& matcher);

}  // namespace delquad
