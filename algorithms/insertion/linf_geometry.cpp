#include "algorithms/insertion/linf_geometry.h"

#include <algorithm>
#include <cmath>

namespace delquad {

Frame Frame::from_angle(double theta) {
  const Vec2 e1{std::cos(theta), std::sin(theta)};
  return {e1, perp(e1)};
}

CanonicalEdge::CanonicalEdge(Vec2 p, Vec2 q, const Frame& axes) : middle(0.5 * (p + q)) {
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

double branch_exit(const CanonicalEdge& edge, Vec2 opposite_apex) {
  const double b = std::abs(edge.beta);
  const double along = std::copysign(opposite_apex.x, edge.beta * opposite_apex.x);
  if (along < -edge.alpha) return 0;
  if (along > edge.alpha) return 2 * b;
  const double slack = edge.alpha - b;
  const double y0 = std::clamp(opposite_apex.y + edge.alpha, -slack, slack);
  return std::min(2 * edge.alpha, edge.alpha + b + y0);
}

namespace {

/// The case in which the box is at least as wide as high; coordinates are (along the wide side, across).
Circumsquare wide_circumsquare(std::array<Vec2, 3> v) {
  std::sort(v.begin(), v.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const double width = v[2].x - v[0].x;
  const auto [low, high] = std::minmax({v[0].y, v[1].y, v[2].y});
  Circumsquare square{{(v[0].x + v[2].x) / 2, (low + high) / 2}, width / 2};
  if (v[1].x == v[0].x || v[1].x == v[2].x) return square;  // all three lie on the left and right sides
  if (v[1].y == high) {
    square.centre.y = high - width / 2;
  } else if (v[1].y == low) {
    square.centre.y = low + width / 2;
  } else {
    square.radius =
        std::numeric_limits<double>::infinity();  // the middle one is inside the box of the others
  }
  return square;
}

}  // namespace

Circumsquare circumsquare(const std::array<Vec2, 3>& triangle, const Frame& frame) {
  std::array<Vec2, 3> wide, high;
  for (int k = 0; k < 3; ++k) {
    wide[k] = frame.to_local(triangle[k]);
    high[k] = {wide[k].y, wide[k].x};
  }
  const auto [x0, x1] = std::minmax({wide[0].x, wide[1].x, wide[2].x});
  const auto [y0, y1] = std::minmax({wide[0].y, wide[1].y, wide[2].y});
  Circumsquare square;
  if (x1 - x0 >= y1 - y0) square = wide_circumsquare(wide);
  if (y1 - y0 > x1 - x0 || (y1 - y0 == x1 - x0 && std::isinf(square.radius))) {
    square = wide_circumsquare(high);
    std::swap(square.centre.x, square.centre.y);
  }
  square.centre = frame.to_global(square.centre);
  return square;
}

}  // namespace delquad
