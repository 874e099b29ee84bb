// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

// This header compares edges with a size. Measures, grids and given meshes use it.

namespace delquad {

/// Returns the adimensional length of the segment from a to b [paper, equation (5)], by adaptive quadrature
/// with a relative error of about 1e-3.
double adimensional_length(const Vec3& a, const Vec3& b, const SizeField& size);

/// Fit of a mesh's edges to a size; all NaN without edges.
struct SizeFit {
  double tau;                ///< efficiency index in percent [paper, equation (6)]
  double shortest, longest;  ///< adimensional lengths
  double n_short;            ///< edges of two elements, on no line, below kShortSide
};
/// Returns the fit; each edge of the sorted half-edges counts once.
SizeFit fit_to_size(const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField& size);

}  // namespace delquad
