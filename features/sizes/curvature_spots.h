#pragma once

#include <vector>

#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Of each curve of the model the elements per full turn that are asked for, by its name, by that of a region
/// it bounds in the domain, or overall; 0: none. Throws InputError for a name that neither a curve has nor a
/// region.
std::vector<double> turns_asked(const PlanarModel& model, const PlanarDomain& domain, const SizeSpec& spec);

/// Curves of the plane whose elements turn by more than curvature allows, in short parts, each with the size
/// that it asks for. Broken lines turn at their corners only, and ask for nothing; so do bends of formulas
/// within less than a thousandth of the curve's parameters.
std::vector<FineSpot> curvature_spots(const PlanarModel& model, const PlanarDomain& domain,
                                      const SizeSpec& spec, const SizeField& base);

}  // namespace delquad
