// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "delquad/extend.h"
#include "delquad/mesh.h"

// This header has plane geometry in the L-infinity norm of a rotated frame [remacle2013, section 4]. Stages
// D and P use it.
//
// It differs from the paper. The printed circumradius is the radius of the smallest enclosing square; here
// it is half the extent. Clamps act on the distance rho from the ends of the edge instead of the parameter
// t.
namespace delquad {

/// Returns max(|x|, |y|) of a vector in frame coordinates.
inline double linf_norm(Vec2 v) { return std::max(std::abs(v.x), std::abs(v.y)); }

/// Returns the larger side of the triangle's bounding box in the frame: twice R_inf of the paper, 1 for half
/// a unit square.
inline double linf_extent(const std::array<Vec2, 3>& triangle, const Frame& frame) {
  const Vec2 a = frame.to_local(triangle[1] - triangle[0]), b = frame.to_local(triangle[2] - triangle[0]);
  const double width = std::max({0.0, a.x, b.x}) - std::min({0.0, a.x, b.x});
  const double height = std::max({0.0, a.y, b.y}) - std::min({0.0, a.y, b.y});
  return std::max(width, height);
}

/// Edge PQ in its canonical frame: origin in the middle, P = (-alpha, -beta), Q = (alpha, beta), alpha > 0
/// and |beta| <= alpha. The side of interest, left of PQ, is up. Its length in the norm is 2 alpha.
struct CanonicalEdge {
  Vec2 middle;
  Frame frame;
  double alpha = 0, beta = 0;
  /// P and Q must be distinct. The frame is `axes`, turned by quarters until the edge is within 45 degrees of
  /// its first axis.
  CanonicalEdge(Vec2 p, Vec2 q, const Frame& axes);
  Vec2 to_local(Vec2 x) const { return frame.to_local(x - middle); }
  Vec2 to_global(Vec2 x) const { return middle + frame.to_global(x); }
  double length() const { return 2 * alpha; }
};

/// Returns the point on the upper branch of the bisector of PQ at distance rho >= alpha from both ends, in
/// canonical coordinates. It is the far common corner of the squares of radius rho about P and Q. The radius
/// 2 alpha gives the apex of the equilateral triangle [remacle2013, section 4.3].
Vec2 bisector_point(const CanonicalEdge& edge, double rho);

/// Returns the radius of the square through P, Q and the apex (canonical coordinates). Its center lies on the
/// upper branch of the bisector. Infinity means no such square.
double circumradius_on_branch(const CanonicalEdge& edge, Vec2 apex);

}  // namespace delquad
