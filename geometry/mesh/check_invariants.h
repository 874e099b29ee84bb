// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

// This header checks that meshes are sound. The pipeline, experiments and tests use it.

namespace delquad {

/// Returns check_invariants() of a mesh with branches: any number of elements may meet on edges of the marked
/// curves (by index).
std::vector<std::string> check_invariants(const Mesh& mesh, const std::vector<char>& branching);
/// Returns the same for a mesh whose indices are in range, with its sorted_half_edges().
std::vector<std::string> check_invariants(const Mesh& mesh, const std::vector<char>& branching,
                                          std::span<const HalfEdge> sides);

/// Returns whether all coordinates are finite.
bool has_finite_points(const Mesh& mesh);

}  // namespace delquad
