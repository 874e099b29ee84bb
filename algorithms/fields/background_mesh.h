// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/box.h"
#include "delquad/mesh.h"

// This header makes coarse triangulations that carry sizes and crosses. Features and fields use it.

namespace delquad {

class TriangleTree;

/// A coarse triangulation of one or more patches in their plane, graded from the boundary's own edges. Its
/// size does not follow the final mesh, so that fields on it stay cheap. Patches share no vertices, also
/// where they touch: each has its own fields.
class BackgroundMesh {
 public:
  /// Refines each patch by CGAL; boundary edges stay or are split. Throws InputError without patches, and if
  /// a boundary crosses itself.
  explicit BackgroundMesh(std::span<const PatchBoundary> patches);
  /// Takes an existing triangulation, counterclockwise, as one patch; its vertices serve as boundary nodes.
  explicit BackgroundMesh(TriPatch triangulation);

  const TriPatch& triangles() const { return tri_; }
  /// Returns the patch that each triangle lies in.
  const std::vector<int>& triangle_patch() const { return patch_; }

  /// Place of a vertex on the boundary: on the edge that begins there or that it splits.
  struct BoundaryPoint {
    int from = -1, to = -1;  ///< nodes of the boundary mesh at the ends of this edge; -1: an interior vertex
    double t = 0;            ///< place on the edge: 0 at `from`, below 1
    Vec2 tangent;            ///< unit direction of this edge
  };
  /// Returns the point of the boundary of each vertex.
  const std::vector<BoundaryPoint>& boundary_points() const { return boundary_; }

  /// A place in the mesh: the triangle that contains u (the first of several), or the nearest one if u is
  /// outside. It has barycentric coordinates there, none negative. Points farther from the bounding box than
  /// its width are first moved to this distance, since searches from far away are slow.
  struct Location {
    int triangle;
    double b[3];
  };
  /// Returns the location of u, found by a visibility walk from the triangle `hint` (-1: any), which becomes
  /// the found one. The result does not depend on the hint.
  Location locate(Vec2 u, int& hint) const;

 private:
  int walk(Vec2 u, int hint) const;
  void set_up_search();
  Vec2 within_reach(Vec2 u) const;

  TriPatch tri_;
  std::vector<int> patch_;
  std::vector<BoundaryPoint> boundary_;
  std::shared_ptr<const TriangleTree> tree_;
  Box<Vec2> reach_;  ///< of locate()
};

}  // namespace delquad
