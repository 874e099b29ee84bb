#pragma once

#include "geometry/surface/surface_model.h"

namespace delquad {

struct ImproveOptions {
  /// Triangles of curved faces whose longest side is this many times their height are split, > 2.
  double max_aspect = 4;
  /// Sides of curved faces longer than this part of the model's diagonal are split; sides are never split
  /// below `min_length`.
  double max_length = 1.0 / 40;
  double min_length = 1.0 / 2000;
};

/// Makes the fine triangulation fit for cotangent weights: edges inside faces are turned to be Delaunay where
/// that does not bend the surface, long sides of curved faces are split and new points moved to the true
/// surface. Lines keep following their curves. Plane faces are only divided along with their neighbours.
void improve_triangulation(SurfaceModel& model, const ImproveOptions& options = {});

/// Length of the diagonal of the bounding box.
double diagonal(const Mesh& mesh);

}  // namespace delquad
