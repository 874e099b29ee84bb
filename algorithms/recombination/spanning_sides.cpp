#include "algorithms/recombination/spanning_sides.h"

#include "geometry/mesh/tri_topology.h"

namespace delquad {

namespace {

/// An interior side of t between two boundary points, -1 when it has none.
int spanning_side_of(const TriPatch& tri, int t) {
  for (int side = 0; side < 3; ++side) {
    if (tri.neighbours[t][side] >= 0 && tri.triangles[t][(side + 1) % 3] < tri.n_boundary &&
        tri.triangles[t][(side + 2) % 3] < tri.n_boundary) {
      return side;
    }
  }
  return -1;
}

}  // namespace

int split_spanning_sides(TriPatch& tri) {
  int cuts = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int side = spanning_side_of(tri, static_cast<int>(t)); side >= 0;
         side = spanning_side_of(tri, static_cast<int>(t))) {
      const auto& v = tri.triangles[t];
      split_side(tri, static_cast<int>(t), side,
                 0.5 * (tri.points[v[(side + 1) % 3]] + tri.points[v[(side + 2) % 3]]));
      ++cuts;
    }
  }
  return cuts;
}

}  // namespace delquad
