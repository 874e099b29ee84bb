#pragma once

#include "geometry/surface/compound_projector.h"

namespace delquad {

/// The former numbers of what is left.
struct TidyGroups {
  EntityGroups faces, curves;
};

/// Takes points out that no triangle and no line has, faces without triangles, curves without lines and
/// corners without curves. Parts the surface where it touches itself at a point without a line.
TidyGroups tidy_model(SurfaceModel& model);

}  // namespace delquad
