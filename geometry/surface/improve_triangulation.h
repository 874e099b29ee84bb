#pragma once

#include "geometry/surface/surface_model.h"

namespace delquad {

struct ImproveOptions {
  /// Sides of a curved face are split when they are longer than this many times the shortest side of their
  /// triangle, as it was given.
  double max_aspect = 4;
  /// Parts of the model's diagonal: sides that are shorter than the first are not split, those that are
  /// longer than the second are in any case.
  double min_length = 1.0 / 80;
  double max_length = 1.0 / 25;
};

/// Makes the fine triangulation fit for cotangent weights: edges inside faces are turned to be Delaunay where
/// that does not bend the surface, long sides of curved faces are split and new points moved to the true
/// surface. Lines keep following their curves. Plane faces are only divided along with their neighbours.
void improve_triangulation(SurfaceModel& model, const ImproveOptions& options = {});

}  // namespace delquad
