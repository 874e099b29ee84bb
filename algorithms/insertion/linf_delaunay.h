// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

// This header compares Delaunay triangulations of two norms. A figure of the paper uses it.

namespace delquad {

/// Delaunay triangulations of the same points in the L2 and L-infinity norms, as edges (sorted pairs of
/// indices, ascending). Edges with both ends on the convex hull are left out, since the L-infinity
/// triangulation need not reach it.
struct LinfDelaunayComparison {
  std::vector<std::array<int, 2>> both, only_l2, only_linf;
};

/// Compares both triangulations [remacle2013, Figure 15] by CGAL's Delaunay_triangulation_2 and
/// Segment_Delaunay_graph_Linf_2. The points must be distinct, and not all on a line.
LinfDelaunayComparison compare_linf_delaunay(const std::vector<Vec2>& points);

}  // namespace delquad
