// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "geometry/planar/check_lines.h"

// This header checks that loops do not touch. Curves, symmetry and periodic sides use it.

namespace delquad {

/// Loops nearer to each other than this part of the model's diagonal touch. It is well above the rounding of
/// coordinates with seven digits, and below any gap that a mesh could fill.
inline constexpr double kTouch = 1e-6;

/// An edge of a loop: the part of a curve between two of its nodes.
struct LoopEdge {
  const Curve* shape;
  double t0, t1;
  Vec2 a, b;
  int loop, curve;
};

/// Throws InputError naming curves and place where two loops touch or cross: by their curves, whose edges may
/// well keep apart.
void check_loops_apart(const std::vector<LoopEdge>& edges, const BoundaryNames& names);

}  // namespace delquad
