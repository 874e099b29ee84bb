#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Two triangles which an extra edge of the dual graph has matched: the first and the last of the fan at a
/// boundary point. Both start with that point; both are counterclockwise.
struct FanEnds {
  std::array<int, 3> first, last;
};

struct BoundaryRepairSummary {
  int pentagon_swaps = 0;
  int duplications = 0;
};

/// Turns each pair of fan ends into quads and adds them to the mesh, which holds everything but them.
///
/// With one quad (b, q, m, r) between the ends (b, p, q) and (b, r, s), the three may become (b, p, q, m) and
/// (b, m, r, s): the pentagon swap. Always possible: the boundary point b is duplicated. The new interior
/// point b' takes its place in all that lies between, and the ends become (b, p, q, b') and (b, b', r, s). It
/// is chosen where its worst quad is clearly better than the swap's. Each b' is placed where the worst of its
/// elements is best. [Remacle et al. 2011, section 4]
///
/// Differs from the paper, which swaps whenever it can and leaves the place of b' open.
BoundaryRepairSummary repair_fans(QuadPatch& mesh, const std::vector<FanEnds>& pairs);

}  // namespace delquad
