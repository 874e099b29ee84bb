#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/curved/curved_geometry.h"

namespace delquad {

/// A corner of a quad between two sides that both lie on lines.
struct CurveCorner {
  int quad, corner;  ///< index into Mesh::quads, 0 to 3
  int out, in;       ///< the lines (indices into Mesh::lines) of the sides after it and before it
  double angle;      ///< inside the quad, between the true curves' tangents: radians, in [-pi / 2, 3 pi / 2)
};

/// All of them, in the quads' order, of a mesh of straight quads. An element that follows both curves has no
/// more than the angle's sine as its scaled Jacobian there.
std::vector<CurveCorner> curve_corners(const Mesh& straight, const ModelGeometry& geometry);

}  // namespace delquad
