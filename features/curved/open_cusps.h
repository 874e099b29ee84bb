#pragma once

#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "features/curved/curve_corners.h"
#include "features/curved/jacobian_bounds.h"
#include "features/curved/model_geometry.h"

namespace delquad {

/// Corners of the model of less (radians) are cusps: nodes of polynomials do not follow curves so well.
inline constexpr double kCuspAngle = 0.01;

/// Where two curves leave a point in the same direction, quads between them have no angle there, and none
/// that follows the curves is proven to be positive. Nodes of both lines slide along their curves, one away
/// from the corner and the other towards it, by the least that helps: then the polynomials leave it at an
/// angle. `corners`: of the straight mesh, of which `mesh` is the curved form; `bounds`: of all quads, kept
/// up to date. No other quad falls below kPoorJacobian by that, or becomes worse where it was.
void open_cusps(Mesh& mesh, const ModelGeometry& geometry, std::span<const CurveCorner> corners,
                std::vector<JacobianBounds>& bounds);

}  // namespace delquad
