#pragma once

#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// The indices of the points in the order in which a Hilbert curve over their bounding box (65 536 cells a
/// side) meets them; points of one cell in index order.
std::vector<int> hilbert_order(std::span<const Vec2> points);

}  // namespace delquad
