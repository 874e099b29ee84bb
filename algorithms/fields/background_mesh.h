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

/// A coarse triangulation of a planar domain (one or more patches), graded from the boundary's own edges. Its
/// size does not follow the final mesh, so that fields on it stay cheap. Patches share no vertices, also
/// where they touch: each has its own fields.
class BackgroundMesh {
 public:
  /// Each patch's boundary edges are kept, maybe split. Throws InputError where a boundary crosses itself.
  explicit BackgroundMesh(std::span<const PatchBoundary> patches);
  /// Takes a triangulation that is there already, counterclockwise, as one patch; its vertices serve as
  /// boundary nodes.
  explicit BackgroundMesh(TriPatch triangulation);

  const TriPatch& triangles() const { return tri_; }
  /// Returns the patch that each triangle lies in.
  const std::vector<int>& triangle_patch() const { return patch_; }

  /// Where a vertex lies on the boundary: on the edge of the patch's boundary which begins there or which it
  /// splits.
  struct BoundaryPoint {
    int from = -1, to = -1;  ///< nodes of the boundary mesh at that edge's ends; -1: an interior vertex
    double t = 0;            ///< 0 at `from`, < 1
    Vec2 tangent;            ///< unit direction of that edge
  };
  /// Returns the point of the boundary of each vertex.
  const std::vector<BoundaryPoint>& boundary_points() const { return boundary_; }

  /// A place in the mesh: the triangle that contains u (the first of several), or the nearest one if u is
  /// outside. It has barycentric coordinates there, none negative. Points farther from the bounding box than
  /// its width are moved to that distance first. Otherwise the search among all triangles would use exact
  /// arithmetic for nothing.
  struct Location {
    int triangle;
    double b[3];
  };
  /// Finds the triangle by a visibility walk from `hint` (-1: from anywhere), which it then sets to the
  /// triangle. The answer is the same for any hint.
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
