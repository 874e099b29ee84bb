// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

// This header makes sizes by curvature in the plane. The composition of sizes uses it.

namespace delquad {

/// Returns for each curve of the model the requested elements per full turn; 0: none. Requests go by the name
/// of the curve, by the name of a region that it bounds, or overall. Throws InputError for a name that no
/// curve and no region has.
std::vector<double> requested_turns(const PlanarModel& model, const PlanarDomain& domain,
                                    const SizeSpec& spec);

/// Returns short parts of planar curves whose elements turn by more than curvature allows, each with its
/// size. Polylines turn only at their corners and get none; so do bends of formulas within less than 0.001 of
/// the parameters. Own method.
std::vector<LocalSize> curvature_spots(const PlanarModel& model, const PlanarDomain& domain,
                                       const SizeSpec& spec, const SizeField& base);

}  // namespace delquad
