#pragma once

#include <vector>

#include "base/warning.h"
#include "geometry/surface/periodic_faces.h"

namespace delquad {

/// What periodic sides of a surface model are: faces where both names are those of faces, else curves. Throws
/// InputError for names that nothing has, for faces that do not match and for those of two pairs.
PeriodicSides find_periodic_sides(const SurfaceModel& model, const std::vector<PeriodicPair>& asked,
                                  std::vector<Warning>& warnings);

}  // namespace delquad
