#pragma once

#include <array>
#include <vector>

#include "mesh/vec.h"

namespace delquad {

/// The closed boundary of one patch, discretised, in the patch's parameter plane.
struct PatchBoundary {
  std::vector<Vec2> points;
  /// Indices into `points`; the patch lies on the left of each edge, and every point has one edge in, one
  /// out.
  std::vector<std::array<int, 2>> edges;
  /// Curve of each edge (index into Mesh::curves).
  std::vector<int> edge_curve;
  /// Node of the boundary mesh that each point stands for. Two points may share a node (a seam).
  std::vector<int> point_node;
  /// Points inside from which insertion starts, besides the boundary; mostly none.
  std::vector<Vec2> seeds;
};

/// A triangulation of one patch in its parameter plane.
struct TriPatch {
  /// The boundary's points first, in their order, then the inserted ones.
  std::vector<Vec2> points;
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise
  std::vector<std::array<int, 3>>
      neighbours;      ///< neighbours[t][k] lies across the side opposite to vertex k; -1: boundary
  int n_boundary = 0;  ///< how many of the points are the boundary's
};

/// A quadrilateral mesh of one patch in its parameter plane.
struct QuadPatch {
  std::vector<Vec2> points;                   ///< the boundary's points first, in their order
  std::vector<std::array<int, 4>> quads;      ///< counterclockwise
  std::vector<std::array<int, 3>> triangles;  ///< leftovers; empty when the boundary is even
  int n_boundary = 0;
};

}  // namespace delquad
