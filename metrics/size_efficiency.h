#pragma once

#include <span>

#include "fields/size_field.h"
#include "mesh/half_edges.h"
#include "mesh/mesh.h"

namespace delquad {

/// Adimensional length of the segment from a to b, equation (5), by adaptive quadrature (relative error about
/// 1e-3).
double adimensional_length(const Vec3& a, const Vec3& b, const SizeField& size);

/// Efficiency index in percent, equation (6), over the edges of sorted half-edges, each once; NaN without
/// edges.
double efficiency_index(const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField& size);

}  // namespace delquad
