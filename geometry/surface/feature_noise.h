// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

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
/// neighbor with which they share most). Noise is what is made of very few edges, or of edges not much
/// sharper than those beside it, while those beside it are not smooth either: an edge of a machined part
/// stands out from what is around it, one of a scan does not. Free edges, given lines and borders of regions
/// stay.
/// `twin`: see side_twins; `angle`: of each side, radians between the normals; `cut`: of each side, the same
/// on both sides of an edge.
DroppedFeatures drop_noise(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
                           std::vector<int>& cut);

}  // namespace delquad
