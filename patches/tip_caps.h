#pragma once

#include <functional>
#include <vector>

#include "patches/boundary_cap.h"

namespace delquad {

/// A cone is laid flat by a cut to its tip. Where it is pointed, the corner there takes one quad, but both of
/// its sides are the same, and that quad would meet itself. Such corners are cut off the boundary, at the
/// first node of the cut from which enough edges go around the cone; two quads take their place. In the
/// boundary three points stand instead of the tip, so that the number of its edges keeps its parity.
/// `add_node` makes a node at a point of the parameter plane.
std::vector<BoundaryCap> cap_tips(PatchBoundary& boundary, const std::function<int(Vec2)>& add_node);

}  // namespace delquad
