// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

// This header removes sharp edges that are noise. Triangulated models use it.

namespace delquad {

/// Kinds of sides of a triangle: no cut, or a cut that was found. Other kinds are indices of given curves.
constexpr int kNoCut = -2, kNewCut = -1;

/// Returns for each triangle its part of the surface between cuts, in the order of their first triangles.
/// `twin` has the side_twins(), `cut` the kind of each side.
std::vector<int> parts_between_cuts(const std::vector<int>& twin, const std::vector<int>& cut);

struct DroppedFeatures {
  std::size_t islands = 0, edges = 0;
  Vec3 at;  ///< place of the first
};

/// Removes cuts from noise (own method): short networks, and small faces, which join the neighbor with the
/// longest common border. Noise has very few edges, or edges not much sharper than their rough surroundings.
/// Edges of machined parts stand out from their surroundings, edges of scans do not. Free edges, given lines
/// and borders of regions stay. `twin` has the side_twins(), `angle` the angle between the normals at each
/// side (radians). `cut` has the kind of each side, the same on both sides of an edge.
DroppedFeatures drop_noise(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
                           std::vector<int>& cut);

}  // namespace delquad
