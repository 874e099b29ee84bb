#pragma once

#include <vector>

#include "base/warning.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Tells of the narrowest gap outside of all regions, between curves that do not meet, that is narrower than
/// a hundredth of the edges there: regions that were meant to lie side by side.
void warn_of_gaps(const PlanarDomain& domain, std::vector<Warning>& warnings);

}  // namespace delquad
