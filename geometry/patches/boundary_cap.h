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
  int points;                             ///< number of boundary points that replace it
  std::vector<std::array<int, 4>> quads;  ///< nodes of the boundary mesh, oriented like the patch
  std::vector<int> within;                ///< nodes besides the tip that left the patch's boundary
  std::vector<int> dropped;               ///< removed nodes of curves
};

/// A point of a boundary loop, in the parameter plane; an edge leads to the next one.
struct LoopPoint {
  Vec2 point;
  int node, curve;  ///< node here, and curve of the edge that begins here
};
using BoundaryLoop = std::vector<LoopPoint>;
/// Returns the boundary of these loops.
PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops);

/// Cuts the tips of cones off a boundary, and returns their quads (own method). A cut to its tip opens a
/// cone. The corner there takes one quad, which would meet itself, as both sides are the same. Such a corner
/// is cut off at the first node of the cut with enough edges around the cone, and filled by two quads. Three
/// points replace the tip, so that the number of edges keeps its parity. `add_node` returns a new node at a
/// point of the parameter plane.
std::vector<BoundaryCap> cap_tips(PatchBoundary& boundary, const std::function<int(Vec2)>& add_node);

/// Access to the nodes of caps.
struct CapNodes {
  std::function<bool(int node)> may_be_cut;  ///< whether a node may be cut off: corners of the model
  std::function<Vec3(int node)> place;
  std::function<Vec3(const Vec3&, Vec2)> to_face;  ///< projects a point to the near face, with a guess
  std::function<Vec3(Vec2)> normal;                ///< normal of the face, of any length
  std::function<int(const Vec3&)> add;             ///< adds a node, and returns it
  double narrow = 0.25;                            ///< largest distance of its sides, in edges
  bool ends_with_curve = true;                     ///< whether a cap ends where a curve at its corner ends
};

/// Cuts corners sharper than kLeastSharedAngle off a boundary, as far as both sides are near, and returns
/// their quads (own method). There the parameter plane may be too inexact, and only one mesh is good. A quad
/// fills the corner. Its fourth vertex is so far inside that its other angles are equal. Two rows of quads
/// follow between opposite nodes. One point, halfway between the last two nodes, replaces the cut part.
/// Corners whose curves end at the first node stay.
std::vector<BoundaryCap> cap_corners(PatchBoundary& boundary, const CapNodes& nodes);

}  // namespace delquad
