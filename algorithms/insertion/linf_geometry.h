#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "delquad/extend.h"
#include "delquad/mesh.h"

/// Plane geometry in the L-infinity norm of a rotated frame [remacle2013, section 4].
///
/// Differs from the paper: the circumradius that is printed there is the radius of the smallest enclosing
/// square, and is called half the extent here; clamps act on the distance rho from the edge's ends instead of
/// on the parameter t.
namespace delquad {

/// max(|x|, |y|) of a vector in frame coordinates.
inline double linf_norm(Vec2 v) { return std::max(std::abs(v.x), std::abs(v.y)); }

/// Larger side of the triangle's bounding box in the frame: twice the paper's R_inf. 1 for half a unit
/// square.
inline double linf_extent(const std::array<Vec2, 3>& triangle, const Frame& frame) {
  const Vec2 a = frame.to_local(triangle[1] - triangle[0]), b = frame.to_local(triangle[2] - triangle[0]);
  const double width = std::max({0.0, a.x, b.x}) - std::min({0.0, a.x, b.x});
  const double height = std::max({0.0, a.y, b.y}) - std::min({0.0, a.y, b.y});
  return std::max(width, height);
}

/// An edge PQ in its canonical frame: origin in its middle, P = (-alpha, -beta), Q = (alpha, beta) with
/// alpha > 0 and |beta| <= alpha, and the side of interest (left of PQ) up. Its length in the norm is e = 2
/// alpha.
struct CanonicalEdge {
  Vec2 middle;
  Frame frame;
  double alpha = 0, beta = 0;
  /// P and Q must differ.
  CanonicalEdge(Vec2 p, Vec2 q, const Frame& axes);
  Vec2 to_local(Vec2 x) const { return frame.to_local(x - middle); }
  Vec2 to_global(Vec2 x) const { return middle + frame.to_global(x); }
  double length() const { return 2 * alpha; }
};

/// The point of the upper branch of the bisector of PQ whose distance from both ends is rho >= alpha
/// (canonical coordinates): the far corner common to the squares of radius rho about P and Q. rho = 2 alpha
/// is the apex of the equilateral triangle [section 4.3].
Vec2 bisector_point(const CanonicalEdge& edge, double rho);

/// Radius of the square through P, Q and the apex (canonical coordinates) whose centre lies on the upper
/// branch of the bisector; infinity when there is none.
double circumradius_on_branch(const CanonicalEdge& edge, Vec2 apex);

}  // namespace delquad
