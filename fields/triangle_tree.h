#pragma once

#include <vector>

#include "mesh/patch.h"

namespace delquad {

/// Bounding boxes of triangles in a binary tree: finds triangles by place, whatever their grading.
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
  struct Node {
    Vec2 low, high;
    int begin, end;  ///< range of order_
    int right;       ///< second child, the first being the next node; -1: a leaf
  };
  int build(const TriPatch& tri, int begin, int end);

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace delquad
