#pragma once

#include <vector>

#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Curves of the plane whose elements turn by more than curvature allows, in short parts, each with the size
/// that it asks for. Broken lines turn at their corners only, and ask for nothing. Throws InputError for a
/// name of curvature that neither a curve has nor the region of a loop.
std::vector<FineSpot> curvature_spots(const PlanarModel& model, const SizeSpec& spec, const SizeField& base);

}  // namespace delquad
