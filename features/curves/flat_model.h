// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header turns planar domains into surfaces with flat faces. The preparation, symmetry and measures of
// models use it.

namespace delquad {

/// Returns the regions of a domain, triangulated between the points of their boundary.
SurfaceModel flat_model(const PlanarDomain& domain, const std::string& source);

/// Returns a planar model as a surface in z = 0, with a flat face for each region and the model's curves as
/// true geometry. Curves run as in the model in the chords of chord_domain(), and all compulsory nodes of the
/// model are corners. Single points inside of regions are LooseLines. Throws InputError as chord_domain(),
/// and for cracks between two regions.
SurfaceModel flat_surface(const PlanarModel& model, const SizeField& size);

}  // namespace delquad
