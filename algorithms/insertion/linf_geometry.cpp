// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_geometry.h"

#include <cassert>
#include <limits>

namespace delquad {

Frame Frame::from_angle(double theta) {
  const Vec2 e1{std::cos(theta), std::sin(theta)};
  return {e1, perp(e1)};
}

CanonicalEdge::CanonicalEdge(Vec2 p, Vec2 q, const Frame& axes) : middle(0.5 * (p + q)) {
  assert(p != q);
  const Vec2 half = 0.5 * (q - p);
  const Vec2 a = axes.to_local(half);
  const bool along_first = std::abs(a.x) >= std::abs(a.y);
  const Vec2 major = along_first ? axes.e1 : axes.e2;
  frame.e1 = (along_first ? a.x : a.y) > 0 ? major : -major;
  frame.e2 = perp(frame.e1);  // up is left of PQ, because PQ is within 45 degrees of e1
  alpha = dot(half, frame.e1);
  beta = dot(half, frame.e2);
}

Vec2 bisector_point(const CanonicalEdge& edge, double rho) {
  return {-std::copysign(rho - edge.alpha, edge.beta), rho - std::abs(edge.beta)};
}

double circumradius_on_branch(const CanonicalEdge& edge, Vec2 apex) {
  const double b = std::abs(edge.beta);
  const double along = std::copysign(apex.x, edge.beta * apex.x);  // s * o1
  if (along > edge.alpha || apex.y < -b) return std::numeric_limits<double>::infinity();
  return std::max((edge.alpha - along) / 2, (apex.y + b) / 2);
}

}  // namespace delquad
