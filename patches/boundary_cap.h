#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

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
std::vector<BoundaryLoop> take_loops(const PatchBoundary& boundary);
PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops);

}  // namespace delquad
