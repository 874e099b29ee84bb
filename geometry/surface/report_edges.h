#pragma once

#include "geometry/surface/surface_model.h"

namespace delquad {

/// Adds warnings that tell of the curves with a face on one side only, and of those with more than two faces.
void report_edges(SurfaceModel& model);

}  // namespace delquad
