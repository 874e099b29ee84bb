#pragma once

#include <functional>
#include <vector>

#include "mesh/patch.h"

namespace delquad {

/// The point in space of a point of a patch's parameter plane; the hint is carried along between near points.
using PatchLift = std::function<Vec3(Vec2, int& hint)>;

/// Lifts the worst quads of a patch as they are in space, where a coarse mesh of a curved patch has other
/// angles than in the parameter plane: while quads below `eta` improve, moves their interior vertices to
/// where the worst quad around the vertex is best. No least eta around a vertex gets lower. `boundary` are
/// the places of the boundary points; returns those of all others.
std::vector<Vec3> lift_worst_in_space(QuadPatch& patch, const std::vector<Vec3>& boundary,
                                      const PatchLift& lift, double eta, int max_sweeps);

}  // namespace delquad
