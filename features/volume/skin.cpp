// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/hexahedra_steps.h"

#include <cmath>
#include <limits>

namespace delquad {
namespace {

/// Direction of rays, along no plane that models have.
constexpr Vec3 kRay = {1, 0.0271828182846, 0.0314159265359};

bool is_hit(const Vec3& x, const std::array<Vec3, 3>& triangle) {
  const Vec3 a = triangle[0] - x, b = triangle[1] - x, c = triangle[2] - x;
  const double u = dot(kRay, cross(b, c)), v = dot(kRay, cross(c, a)), w = dot(kRay, cross(a, b));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  return sum != 0 && dot(a, cross(b, c)) / sum > 0;
}

}  // namespace

Skin::Skin(const Mesh& body) : body_(body), nearest_(body.points, halves_of(body.quads)) {
  std::vector<Box<Vec3>> boxes;
  for (const Triangle& t : halves_of(body.quads)) {
    corners_.push_back({body.points[t[0]], body.points[t[1]], body.points[t[2]]});
    boxes.push_back(Box<Vec3>::around(std::span<const Vec3>(corners_.back())));
  }
  tree_ = BoxTree<Vec3>(boxes);
}

bool Skin::contains(const Vec3& x) const {
  const auto bound = [&](const BoxTree<Vec3>::Node& node) {
    double from = 0, to = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double speed = coordinate(kRay, k), at = coordinate(x, k);
      from = std::max(from, (coordinate(node.box.low, k) - at) / speed);
      to = std::min(to, (coordinate(node.box.high, k) - at) / speed);
    }
    return from <= to ? 0.0 : 1.0;
  };
  bool inside = false;
  tree_.search(0.0, bound, [&](int t) { inside ^= is_hit(x, corners_[t]); });
  return inside;
}

}  // namespace delquad
