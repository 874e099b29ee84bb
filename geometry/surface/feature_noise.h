// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

// This header removes sharp edges that are noise. Triangulated models use it.

namespace delquad {

/// Kinds of sides of a triangle: nothing lies along it, a cut that was found, or else the index of a given
/// curve.
constexpr int kNoCut = -2, kNewCut = -1;

/// Returns for each triangle its part of the surface between cuts, in the order of their first triangles.
/// `twin`: see side_twins; `cut`: for each side.
std::vector<int> parts_between_cuts(const std::vector<int>& twin, const std::vector<int>& cut);

struct DroppedFeatures {
  std::size_t islands = 0, edges = 0;
  Vec3 at;  ///< a point of the first
};

/// Takes away cuts that noise makes: short networks of them, and small faces between them (these join the
/// neighbor with which they share most). Noise is made of very few edges, or of edges not much sharper than
/// the edges beside them, which are not smooth either. An edge of a machined part stands out from its
/// surroundings, an edge of a scan does not. Free edges, given lines and borders of regions stay. `twin`: see
/// side_twins; `angle`: of each side, radians between the normals; `cut`: of each side, the same on both
/// sides of an edge.
DroppedFeatures drop_noise(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
                           std::vector<int>& cut);

}  // namespace delquad
