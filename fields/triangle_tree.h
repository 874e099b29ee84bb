#pragma once

#include "base/box_tree.h"
#include "delquad/mesh.h"

namespace delquad {

/// Finds triangles by place, whatever their grading.
class TriangleTree {
 public:
  explicit TriangleTree(const TriPatch& tri);

  /// First of the triangles that contain u, sides included (exact); -1: none.
  int containing(const TriPatch& tri, Vec2 u) const;

  struct Nearest {
    int triangle;  ///< the first of several
    Vec2 point;    ///< of that triangle
  };
  Nearest nearest(const TriPatch& tri, Vec2 u) const;

 private:
  BoxTree<Vec2> tree_;
};

}  // namespace delquad
