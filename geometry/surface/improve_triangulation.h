// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geometry/surface/surface_model.h"

// This header refines and improves fine triangulations. The pipeline, geometry and fields use it.

namespace delquad {

struct ImproveOptions {
  /// Sides of a curved face are split if they are longer than this many times, > 1, the shortest side of
  /// their initial triangle.
  double max_aspect = 4;
  /// Lengths over the model's diagonal: sides shorter than the first stay, sides longer than the second are
  /// always split.
  double min_length = 1.0 / 80;
  double max_length = 1.0 / 25;
};

/// Improves the fine triangulation for cotangent weights (own method). Edges inside faces are flipped to be
/// Delaunay if this does not bend the surface. Long sides of curved faces are split, and new points moved to
/// the true surface. Lines keep following their curves. Plane faces are only divided along with their
/// neighbors.
void improve_triangulation(SurfaceModel& model, const ImproveOptions& options = {});

/// Rule by which refine_triangulation() refines. Nodes are indices into fine.points.
class RefinementRule {
 public:
  virtual ~RefinementRule() = default;
  /// Returns whether the triangle shall be split. `curve[k]` is the curve of the side opposite to nodes[k];
  /// -1: it is no line. It must be false for small triangles, or refinement does not end.
  virtual bool is_too_large(int face, const std::array<int, 3>& nodes,
                            const std::array<int, 3>& curve) const = 0;
  /// Returns whether a side of such a triangle may be split; the longest of these is.
  virtual bool may_split([[maybe_unused]] int face, [[maybe_unused]] int a, [[maybe_unused]] int b) const {
    return true;
  }
  /// Returns the length of a side, which decides on the longest side. `in_space` is its length in space.
  virtual double length([[maybe_unused]] int face, [[maybe_unused]] int a, [[maybe_unused]] int b,
                        double in_space) const {
    return in_space;
  }
  /// Returns whether length() and cotangents() differ from those in space.
  virtual bool has_lengths() const { return false; }
  /// Returns the sum of the cotangents at c and d, opposite to the edge a-b of two triangles of a face.
  virtual double cotangents([[maybe_unused]] int face,
                            [[maybe_unused]] const std::array<int, 4>& abcd) const {
    return 0;
  }
  /// Called after a node was put on the middle of side a-b of a triangle of the face; `curve` as above.
  virtual void node_added(int node, int a, int b, int face, int curve) = 0;
};

/// Splits the longest sides of triangles until none is too large, and flips edges as improve_triangulation().
void refine_triangulation(SurfaceModel& model, RefinementRule& rule);

}  // namespace delquad
