// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "geometry/cad/tessellate.h"
#include "geometry/cad/weld_faces.h"
#include "geometry/surface/surface_model.h"

// This header projects points to true faces and edges. The reader of CAD makes a projector by it.

namespace delquad::cad {

/// Returns the nearest points of the true surfaces and curves. There are closed forms on planes, cylinders,
/// cones, spheres and tori; elsewhere Newton's method starts from the nearest fine triangle or line. A face's
/// surface is taken near the face, not cut off at its boundary. `tolerance` is a length.
std::shared_ptr<const SurfaceProjector> make_projector(std::vector<FaceMesh> faces,
                                                       const std::vector<CurveMesh>& curves,
                                                       double tolerance);

}  // namespace delquad::cad
