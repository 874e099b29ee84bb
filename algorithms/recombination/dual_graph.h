// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/matching/matching.h"
#include "delquad/mesh.h"

// This header has the dual graph for Blossom. Recombination uses it.

namespace delquad {

/// Unit of the cost 1 - signed eta of a merged quad. A rectangle costs 0, a reflex quad more than one unit,
/// and none more than three.
inline constexpr long long kCostUnit = 1'000'000;
/// Cost of an extra edge, above the worst of any hundred good quads.
inline constexpr long long kExtraEdgeCost = 100 * kCostUnit;
/// Cost of an extra edge along boundaries that stray from the cross. It is below the cost of rows of rhombs
/// that carry a single triangle across a grid and shear it.
inline constexpr long long kMisalignedExtraEdgeCost = 5 * kCostUnit / 2;

/// The graph whose perfect matchings merge all triangles of a patch in pairs.
///
/// Nodes are the triangles in Hilbert order, then a spare node for each connected component with an odd
/// number of triangles. The mate of a spare is a leftover triangle. The edges are, in this order:
/// 1. one for each interior side;
/// 2. extra edges [remacle2012blossom, section 4]: one for each boundary point. It joins the first and the
///    last triangle of its fan, unless these are equal or adjacent;
/// 3. for each spare, one to each triangle of its component, at cost 0.
struct DualGraph {
  MatchingGraph graph;
  std::vector<int> triangle;      ///< triangle of each node that is no spare
  int first_extra = 0;            ///< index of the first extra edge
  std::vector<int> extra_vertex;  ///< boundary point of each extra edge
};

/// Returns the indices of the points along a Hilbert curve over their bounding box (65 536 cells a side).
/// Points of one cell are in index order.
std::vector<int> hilbert_order(std::span<const Vec2> points);

/// Returns the quad of triangle t and its neighbor u across a side of t, counterclockwise. Its first corner
/// is opposite to this side.
std::array<int, 4> merged_quad(const TriPatch& tri, int t, int side, int u);

/// Returns the graph with costs in kCostUnit; the triangulation must be counterclockwise, with neighbors.
DualGraph build_dual_graph(const TriPatch& tri, long long extra_edge_cost = kExtraEdgeCost);

/// Returns eta of a counterclockwise quad with a sign, by an extension of [remacle2013, equation (4)]. It is
/// 1 - max |90 deg - angle| / 90 deg over the interior angles in [0, 360) degrees. A rectangle has 1, an
/// angle of 0 or 180 gives 0, and reflex angles give values down to -2.
double signed_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

}  // namespace delquad
