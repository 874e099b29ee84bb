#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// The inner points of a patch along a Hilbert curve, so that what is close in the plane is close in memory:
/// for each its index in the patch.
std::vector<int> spatial_order(const TriPatch& patch);

/// The patch with `order[k]` in the place of its k-th inner point, and its triangles in the order of their
/// points. Boundary points stay where they are.
TriPatch reordered(const TriPatch& patch, const std::vector<int>& order);

}  // namespace delquad
