#include "mesh/nearest_triangle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace delquad {

namespace {

/// How far along from a to b the point nearest to x lies, in [0, 1].
double nearest_fraction(const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 d = b - a;
  const double length2 = dot(d, d);
  return length2 > 0 ? std::clamp(dot(x - a, d) / length2, 0.0, 1.0) : 0;
}

}  // namespace

std::array<double, 3> nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 normal = cross(b - a, c - a);
  const double area2 = dot(normal, normal);
  if (area2 > 0) {
    const double wa = dot(cross(c - b, x - b), normal) / area2, wb = dot(cross(a - c, x - c), normal) / area2;
    if (wa >= 0 && wb >= 0 && wa + wb <= 1) return {wa, wb, 1 - wa - wb};
  }
  const std::array<Vec3, 3> p{a, b, c};
  std::array<double, 3> best{};
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double t = nearest_fraction(p[k], p[next], x);
    const Vec3 d = p[k] + t * (p[next] - p[k]) - x;
    if (dot(d, d) >= best2) continue;
    best2 = dot(d, d);
    best = {};
    best[k] = 1 - t;
    best[next] = t;
  }
  return best;
}

namespace {

std::vector<Box<Vec3>> boxes_of(const std::vector<Vec3>& points,
                                const std::vector<std::array<int, 3>>& triangles) {
  if (triangles.empty()) throw std::invalid_argument("NearestTriangle: no triangles");
  std::vector<Box<Vec3>> boxes;
  boxes.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    boxes.push_back(Box<Vec3>::around({points[a], points[b], points[c]}));
  return boxes;
}

}  // namespace

NearestTriangle::NearestTriangle(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)),
      triangles_(std::move(triangles)),
      boxes_(boxes_of(points_, triangles_)),
      tree_(boxes_) {}

std::pair<std::array<double, 3>, double> NearestTriangle::nearest_in(int t, const Vec3& x) const {
  const Vec3 &a = points_[triangles_[t][0]], &b = points_[triangles_[t][1]], &c = points_[triangles_[t][2]];
  const auto w = nearest_weights(a, b, c, x);
  const Vec3 d = w[0] * a + w[1] * b + w[2] * c - x;
  return {w, dot(d, d)};
}

NearestTriangle::Found NearestTriangle::find_from(int guess, const Vec3& x) const {
  if (guess < 0 || guess >= static_cast<int>(triangles_.size())) return find(x);
  // The square of a square root is off by a rounding: not less than what it came from.
  constexpr double kAtLeast = 1 + 1e-12;
  const Found found = find(x, kAtLeast * std::sqrt(nearest_in(guess, x).second));
  return found.triangle >= 0 ? found : find(x);
}

NearestTriangle::Found NearestTriangle::find(const Vec3& x, double reach) const {
  Found best;
  double best2 = reach * reach;
  tree_.nearest(x, best2, [&](int t) {
    if (boxes_[t].distance2(x) > best2) return;
    const auto [w, d2] = nearest_in(t, x);
    if (d2 > best2 || (d2 == best2 && best.triangle >= 0 && best.triangle < t)) return;
    best2 = d2;
    best = {t, w, 0};
  });
  if (best.triangle >= 0) best.distance = std::sqrt(best2);
  return best;
}

}  // namespace delquad
