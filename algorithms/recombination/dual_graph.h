#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/matching/matching.h"
#include "delquad/mesh.h"

namespace delquad {

/// Cost of the quad that two triangles make, in millionths: 1 - signed eta, so 0 for a rectangle, above a
/// million for a reflex quad, three millions at most.
inline constexpr long long kCostUnit = 1'000'000;
/// Cost of an extra edge: dearer than the worst of any hundred good quads.
inline constexpr long long kExtraEdgeCost = 100 * kCostUnit;
/// The same along boundaries that stray from the cross: less than what rows of rhombs cost, which carry a
/// triangle without partner from one side of a grid to the other, and shear it.
inline constexpr long long kAstrayExtraEdgeCost = 5 * kCostUnit / 2;

/// The graph whose perfect matchings are the ways to merge the triangles of a patch two by two.
///
/// Nodes are the triangles in Hilbert order, then one spare node for each connected component that has an odd
/// number of them; a spare's mate is the triangle that is left over. Edges, in this order:
/// 1. one for each interior side;
/// 2. the extra ones [Remacle et al. 2011, section 4]: for each boundary point one between the first and the
///    last triangle of its fan, unless they are the same or share a side;
/// 3. for each spare, one to every triangle of its component, free of charge.
struct DualGraph {
  MatchingGraph graph;
  std::vector<int> triangle;      ///< of each node that is not a spare
  int first_extra = 0;            ///< index of the first extra edge
  std::vector<int> extra_vertex;  ///< boundary point of each extra edge
};

/// The indices of the points in the order in which a Hilbert curve over their bounding box (65 536 cells a
/// side) meets them; points of one cell in index order.
std::vector<int> hilbert_order(std::span<const Vec2> points);

/// The quad that triangle t and its neighbour u across a side of t make, from t's corner opposite of it.
std::array<int, 4> merged_quad(const TriPatch& tri, int t, int side, int u);

DualGraph build_dual_graph(const TriPatch& tri, long long extra_edge_cost = kExtraEdgeCost);

/// eta of a quad with a sign [paper, equation (4), extended]: 1 - max |90 deg - angle| / 90 deg over the four
/// interior angles, taken in [0, 360) degrees. 1 for a rectangle, 0 with an angle of 0 or 180, below 0 (down
/// to -2) the further an angle is reflex, so that bad quads can be told from worse ones.
double signed_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

}  // namespace delquad
