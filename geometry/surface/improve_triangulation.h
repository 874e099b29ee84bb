// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geometry/surface/surface_model.h"

// This header refines and improves fine triangulations. The pipeline, geometry and fields use it.

namespace delquad {

struct ImproveOptions {
  /// Sides of a curved face are split when they are longer than this many times the shortest side of their
  /// triangle, as it was given.
  double max_aspect = 4;
  /// Parts of the model's diagonal: sides shorter than the first are not split, and sides longer than the
  /// second are in any case.
  double min_length = 1.0 / 80;
  double max_length = 1.0 / 25;
};

/// Makes the fine triangulation fit for cotangent weights. Edges inside faces are turned to be Delaunay where
/// that does not bend the surface. Long sides of curved faces are split, and new points moved to the true
/// surface. Lines keep following their curves. Plane faces are only divided along with their neighbors.
void improve_triangulation(SurfaceModel& model, const ImproveOptions& options = {});

/// Tells refine_triangulation() where to refine. Nodes are indices into fine.points.
class RefinementRule {
 public:
  virtual ~RefinementRule() = default;
  /// Returns whether the triangle is to be split. `curve[k]`: the curve of the side opposite to nodes[k]; -1:
  /// it is no line. Must be false for triangles that are small enough in some sense, or refinement does not
  /// end.
  virtual bool is_too_large(int face, const std::array<int, 3>& nodes,
                            const std::array<int, 3>& curve) const = 0;
  /// Returns the length of a side, by which the longest is told, and what is Delaunay; `in_space`: that
  /// there.
  virtual double length([[maybe_unused]] int face, [[maybe_unused]] int a, [[maybe_unused]] int b,
                        double in_space) const {
    return in_space;
  }
  /// Returns whether that is another than in space.
  virtual bool has_lengths() const { return false; }
  /// A node was put on the middle of the side a-b, of a triangle of the face; `curve`: as above.
  virtual void node_added(int node, int a, int b, int face, int curve) = 0;
};

/// Splits the longest sides of triangles that are too large until none is, with the same care as
/// improve_triangulation().
void refine_triangulation(SurfaceModel& model, RefinementRule& rule);

}  // namespace delquad
