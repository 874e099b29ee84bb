#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// The Delaunay triangulations of the same points in the L2 and in the L-infinity norm, as edges (sorted
/// pairs of point indices, ascending). Edges with both ends on the convex hull are left out of the
/// comparison: the L-infinity triangulation need not reach the hull.
struct LinfDelaunayComparison {
  std::vector<std::array<int, 2>> both, only_l2, only_linf;
};

/// Compares the two kernels [remacle2013, Figure 15] with CGAL's Delaunay_triangulation_2 and
/// Segment_Delaunay_graph_Linf_2. The points must differ from each other.
LinfDelaunayComparison compare_linf_delaunay(const std::vector<Vec2>& points);

}  // namespace delquad
