// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header turns planar domains into surfaces with flat faces. Symmetry and measures of models use it.

namespace delquad {

/// Returns the regions of a domain, triangulated between the points of their boundary.
SurfaceModel flat_model(const PlanarDomain& domain, const std::string& source);

/// Returns the true curves of a domain, at which its faces end. All of them are one to SurfaceProjector.
std::shared_ptr<const SurfaceProjector> flat_projector(const PlanarDomain& domain, const Mesh& fine);

}  // namespace delquad
