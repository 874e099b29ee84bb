#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// The directions of a cross field in space at the place nearest to x; nothing where that is further than
/// `reach`. `hint` as in SizeField::at.
using CrossInSpace =
    std::function<std::optional<std::array<Vec3, 2>>(const Vec3& x, double reach, int& hint)>;

/// The mean angle between the edges of two quads and the nearest direction of the field at their middles, in
/// degrees: of edges that follow it everywhere 0, of random ones 22.5. NaN without such edges.
double mean_misalignment(const Mesh& mesh, std::span<const HalfEdge> sides, const CrossInSpace& cross_at);

}  // namespace delquad
