// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesher.h"
#include "geometry/planar/planar_model.h"

// This header makes rows around holes in the plane. The preparation uses it.

namespace delquad {

/// Returns the problem of a planar model of curves with its washers as layers and numbers of edges of holes.
/// `size` is the requested size.
MeshProblem with_planar_washers(MeshProblem problem, const PointSize& size, std::vector<Warning>& warnings);

}  // namespace delquad
