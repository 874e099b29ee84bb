// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesher.h"
#include "geometry/planar/planar_model.h"

// This header makes rows around holes in the plane. The preparation uses it.

namespace delquad {

/// Returns the problem of a planar model of curves with what its washers come to: numbers of edges of holes,
/// and layers. `size`: that is asked for.
MeshProblem with_planar_washers(MeshProblem problem, const SizeField& size, std::vector<Warning>& warnings);

}  // namespace delquad
