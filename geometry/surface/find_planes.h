#pragma once

#include <string>
#include <vector>

#include "geometry/surface/mirror_match.h"

namespace delquad {

struct FoundPlanes {
  std::vector<SymmetryPlane> planes;  ///< perpendicular to each other
  std::string spoiled;  ///< a plane that would be one more, and the embedded item without an image; or empty
};

/// The planes at which a model is symmetric; none where none are found. They go
/// through the middle of the model or the centroid of its surface. Of those that are equally good, the ones
/// that are perpendicular to x, y and z come first.
FoundPlanes find_symmetry_planes(const SurfaceModel& model, const MirrorMatcher& matcher);

}  // namespace delquad
