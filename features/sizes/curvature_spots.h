// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "features/sizes/fine_spots.h"
#include "geometry/planar/planar_model.h"

// This header makes sizes by curvature in the plane. The composition of sizes uses it.

namespace delquad {

/// Returns for each curve of the model the requested elements per full turn; 0: none. The request is by its
/// name, by the name of a region that it bounds in the domain, or overall. Throws InputError for a name that
/// no curve and no region has.
std::vector<double> requested_turns(const PlanarModel& model, const PlanarDomain& domain,
                                    const SizeSpec& spec);

/// Curves of the plane whose elements turn by more than curvature allows, in short parts, each with the size
/// that it asks for. Broken lines turn at their corners only, and ask for nothing; so do bends of formulas
/// within less than a thousandth of the curve's parameters.
std::vector<LocalSize> curvature_spots(const PlanarModel& model, const PlanarDomain& domain,
                                       const SizeSpec& spec, const SizeField& base);

}  // namespace delquad
