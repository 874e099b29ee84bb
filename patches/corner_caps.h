#pragma once

#include <functional>
#include <vector>

#include "patches/boundary_cap.h"

namespace delquad {

/// How a cap gets its nodes.
struct CapNodes {
  std::function<bool(int node)> may_be_cut;  ///< corners of the model
  std::function<Vec3(int node)> place;
  std::function<Vec3(const Vec3&, Vec2)> to_face;  ///< a point near the face, and about where in the plane
  std::function<Vec3(Vec2)> normal;                ///< of the face, any length
  std::function<int(const Vec3&)> add;             ///< returns the node
};

/// Cuts sharp corners off a boundary, as far as the two curves are nearer to each other than half an edge:
/// there the parameter plane may be less exact than they are apart, and there is one good mesh only. A quad
/// fills the corner, whose fourth vertex is so far inside that its other angles are alike, and two rows of
/// quads lie between nodes that are opposite each other; the cap ends where they are not. In the boundary one
/// point stands instead of all that is cut off, halfway between the last two nodes. Corners whose curves end
/// at the first node are left alone.
std::vector<BoundaryCap> cap_corners(PatchBoundary& boundary, const CapNodes& nodes);

}  // namespace delquad
