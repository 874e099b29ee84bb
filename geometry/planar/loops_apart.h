// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "geometry/planar/check_lines.h"

// This header checks that loops do not touch. Curves, symmetry and periodic sides use it.

namespace delquad {

/// Distance, over the model's diagonal, below which loops touch. It is well above the rounding of coordinates
/// with seven digits, and below any gap that a mesh could fill.
inline constexpr double kTouch = 1e-6;

/// An edge of a loop: the part of a curve between two of its nodes.
struct LoopEdge {
  const Curve* shape;
  double t0, t1;
  Vec2 a, b;
  int loop, curve;
};

/// Throws InputError, with curves and place, if two loops touch or cross along their curves, even if edges do
/// not (own method).
void check_loops_apart(const std::vector<LoopEdge>& edges, const BoundaryNames& names);

}  // namespace delquad
