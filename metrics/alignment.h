// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

// This header measures the alignment of quads with a cross field. The measures use it.

namespace delquad {

/// Returns two directions of a cross field in space at the place nearest to x; nothing if that is farther
/// than `reach`. `hint` is as in SizeField::at.
using CrossInSpace =
    std::function<std::optional<std::array<Vec3, 2>>(const Vec3& x, double reach, int& hint)>;

/// Returns the mean angle, in degrees, between inner edges of quads and the nearest direction of the field at
/// their middles. It is 0 for perfect alignment, 22.5 for random edges, and NaN without such edges. `sides`
/// is sorted_half_edges() of the mesh. Own measure.
double mean_misalignment(const Mesh& mesh, std::span<const HalfEdge> sides, const CrossInSpace& cross_at);

}  // namespace delquad
