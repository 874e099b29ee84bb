// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "delquad/mesh.h"

// This header cuts quads off corners of patches. Curves, thin features and layers use it.

namespace delquad {

/// Quads that are cut off a patch at a corner of its boundary, where insertion has no choice.
struct BoundaryCap {
  int tip;                                ///< node of the corner
  int points;                             ///< of the boundary that stand in its place
  std::vector<std::array<int, 4>> quads;  ///< nodes of the boundary mesh, oriented as the patch
  std::vector<int> within;   ///< nodes that are no longer on the patch's boundary, besides the tip
  std::vector<int> dropped;  ///< nodes of curves that are no longer there at all
};

/// A boundary as loops of its points, from each an edge to the next.
struct LoopPoint {
  Vec2 point;
  int node, curve;  ///< of the edge that begins here
};
using BoundaryLoop = std::vector<LoopPoint>;
PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops);

/// Cuts the tips of cones off. A cone is laid flat by a cut to its tip. Where it is pointed, the corner there
/// takes one quad. Both of its sides are the same, and that quad would meet itself. Such corners are cut off
/// the boundary, at the first node of the cut from which enough edges go around the cone. Two quads take
/// their place. In the boundary three points stand instead of the tip, so that the number of its edges keeps
/// its parity. `add_node` makes a node at a point of the parameter plane.
std::vector<BoundaryCap> cap_tips(PatchBoundary& boundary, const std::function<int(Vec2)>& add_node);

/// How a cap gets its nodes.
struct CapNodes {
  std::function<bool(int node)> may_be_cut;  ///< corners of the model
  std::function<Vec3(int node)> place;
  std::function<Vec3(const Vec3&, Vec2)> to_face;  ///< a point near the face, and about where in the plane
  std::function<Vec3(Vec2)> normal;                ///< of the face, any length
  std::function<int(const Vec3&)> add;             ///< returns the node
  double narrow = 0.25;                            ///< a cap ends where its sides are further apart, in edges
  bool ends_with_curve = true;                     ///< and where one of the curves at its corner ends
};

/// Cuts corners sharper than kLeastSharedAngle off a boundary, as far as the two sides are near to each
/// other: there the parameter plane may be less exact than they are apart, and there is one good mesh only. A
/// quad fills the corner, whose fourth vertex is so far inside that its other angles are alike. Two rows of
/// quads lie between nodes that are opposite each other, and the cap ends where they are not. In the boundary
/// one point, halfway between the last two nodes, stands instead of the part that is cut off. Corners whose
/// curves end at the first node are left alone.
std::vector<BoundaryCap> cap_corners(PatchBoundary& boundary, const CapNodes& nodes);

}  // namespace delquad
