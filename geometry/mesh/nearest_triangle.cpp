// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/nearest_triangle.h"
#include "base/segment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace delquad {

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
    const double t = nearest_part(x, p[k], p[next]);
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

/// Longest side over height of a part, and limit of parts of a triangle.
constexpr double kAspectOfPart = 8;
constexpr double kMostParts = 64;

/// Margin for rounding, in longest sides.
constexpr double kRounding = 1e-12;

/// Adds boxes around the parts of a triangle, which is cut evenly across its longest side. A triangle with
/// two equal corners, as for a line, has one.
void add_boxes(std::array<Vec3, 3> x, std::vector<Box<Vec3>>& boxes) {
  const auto length2 = [&](int k) { return dot(x[(k + 1) % 3] - x[k], x[(k + 1) % 3] - x[k]); };
  const int longest = length2(0) >= std::max(length2(1), length2(2)) ? 0 : length2(1) >= length2(2) ? 1 : 2;
  std::rotate(x.begin(), x.begin() + longest, x.end());
  const auto& [a, b, c] = x;
  const double side2 = dot(b - a, b - a), area2 = norm(cross(b - a, c - a));
  const double wanted = side2 > kAspectOfPart * area2 ? side2 / (kAspectOfPart * area2) : 1;
  const int n = wanted < kMostParts ? static_cast<int>(wanted) : static_cast<int>(kMostParts);
  if (n <= 1 || c == a || c == b) {
    boxes.push_back(Box<Vec3>::around({a, b, c}));
    return;
  }
  const double peak = nearest_part(c, a, b);
  const auto below = [&](double t) { return a + t * (b - a); };
  const auto above = [&](double t) {
    return t < peak ? a + (t / peak) * (c - a) : t < 1 ? c + ((t - peak) / (1 - peak)) * (b - c) : b;
  };
  for (int i = 0; i < n; ++i) {
    const double from = double(i) / n, to = double(i + 1) / n;
    std::vector<Vec3> corners = {below(from), below(to), above(from), above(to)};
    if (peak >= from && peak <= to) corners.push_back(c);
    boxes.push_back(Box<Vec3>::around(corners).grown(kRounding * std::sqrt(side2)));
  }
}

}  // namespace

NearestTriangle::NearestTriangle(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  if (triangles_.empty()) throw std::invalid_argument("NearestTriangle: no triangles");
  parts_.reserve(triangles_.size());
  std::vector<Box<Vec3>> boxes;
  boxes.reserve(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    add_boxes({points_[a], points_[b], points_[c]}, boxes);
    while (parts_.size() < boxes.size()) parts_.push_back({static_cast<int>(t), boxes[parts_.size()]});
  }
  tree_ = BoxTree<Vec3>(boxes);
}

std::pair<std::array<double, 3>, double> NearestTriangle::nearest_in(int t, const Vec3& x) const {
  const Vec3 &a = points_[triangles_[t][0]], &b = points_[triangles_[t][1]], &c = points_[triangles_[t][2]];
  const auto w = nearest_weights(a, b, c, x);
  const Vec3 d = w[0] * a + w[1] * b + w[2] * c - x;
  return {w, dot(d, d)};
}

NearestTriangle::Found NearestTriangle::find_from(int guess, const Vec3& x) const {
  if (guess < 0 || guess >= static_cast<int>(triangles_.size())) return find(x);
  // Factor for rounding, so that the square of a square root is no less than its argument.
  constexpr double kAtLeast = 1 + 1e-12;
  const Found found = find(x, kAtLeast * std::sqrt(nearest_in(guess, x).second));
  return found.triangle >= 0 ? found : find(x);
}

NearestTriangle::Found NearestTriangle::find(const Vec3& x, double reach) const {
  Found best;
  double best2 = reach * reach;
  tree_.nearest(x, best2, [&](int item) {
    const auto& [t, box] = parts_[item];
    if (box.distance2(x) > best2) return;
    const auto [w, d2] = nearest_in(t, x);
    if (d2 > best2 || (d2 == best2 && best.triangle >= 0 && best.triangle < t)) return;
    best2 = d2;
    best = {t, w, 0};
  });
  if (best.triangle >= 0) best.distance = std::sqrt(best2);
  return best;
}

}  // namespace delquad
