#pragma once

#include <array>
#include <vector>

#include "mesh/vec.h"

namespace delquad::cad {

/// Finds the triangle nearest to a point of space: bounding boxes in a binary tree.
class NearestTriangle {
 public:
  NearestTriangle(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);

  struct Found {
    std::array<int, 3> vertices;    ///< of the triangle
    std::array<double, 3> weights;  ///< of its vertices in the nearest point; sum 1
  };
  Found find(const Vec3& x) const;

 private:
  struct Box {
    Vec3 low, high;
  };
  struct Node {
    Box box;
    int begin, end;  ///< range of triangles_
    int right;       ///< second child, the first being the next node; -1: a leaf
  };
  int build(int begin, int end);
  Box box_of(int begin, int end) const;

  std::vector<Vec3> points_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Node> nodes_;
};

/// Weights of the vertices in the point of the triangle that is nearest to x.
std::array<double, 3> nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x);

}  // namespace delquad::cad
