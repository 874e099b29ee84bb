// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "geometry/cad/tessellate.h"
#include "geometry/cad/weld_faces.h"
#include "geometry/surface/surface_model.h"

// This header projects points to true faces and edges. The reader of CAD makes a projector by it.

namespace delquad::cad {

/// Returns a projector to the nearest points of the true surfaces and curves. It has closed forms on planes,
/// cylinders, cones, spheres and tori; elsewhere Newton's method starts from the nearest fine triangle or
/// line. The surface near a face counts, also beyond its boundary. `tolerance` > 0 is a length, of the last
/// step.
std::shared_ptr<const SurfaceProjector> make_projector(std::vector<FaceMesh> faces,
                                                       const std::vector<CurveMesh>& curves,
                                                       double tolerance);

}  // namespace delquad::cad
