#pragma once

#include <vector>

#include "delquad/model.h"

namespace delquad {

/// What tells one geometry from another wherever it lies, however it is turned, mirrored or scaled and
/// whatever its names: the number of loops, the length of its curves, and magnitudes of complex moments of
/// that length of its curves, in radii of gyration [flusser2000].
std::vector<double> geometry_moments(const PlanarModel& model);

}  // namespace delquad
