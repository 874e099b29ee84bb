#pragma once

#include <span>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// Adimensional length of the segment from a to b, equation (5), by adaptive quadrature (relative error about
/// 1e-3).
double adimensional_length(const Vec3& a, const Vec3& b, const SizeField& size);

/// How the lengths of a mesh's edges fit a size. All NaN without edges.
struct SizeFit {
  double tau;                ///< efficiency index in percent, equation (6)
  double shortest, longest;  ///< adimensional lengths
  double n_short;            ///< edges in two elements and on no line that are below kShortSide
};
/// Over the edges of sorted half-edges, each once.
SizeFit fit_to_size(const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField& size);

}  // namespace delquad
