// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/mesh.h"

#include "base/box.h"

namespace delquad {
namespace {

/// Returns x, rounded if it is nearly whole, as cosines and sines of quarter turns are.
double without_rounding(double x) {
  constexpr double kRounding = 1e-15;
  return std::abs(x - std::round(x)) < kRounding ? std::round(x) : x;
}

}  // namespace

double diagonal(const Mesh& mesh) { return diagonal(mesh.points); }

Vec3 Motion::operator()(const Vec3& x) const {
  if (angle == 0) return x + shift;
  const Vec3 u = (1 / norm(axis)) * axis, d = x - centre;
  const double c = without_rounding(std::cos(angle)), s = without_rounding(std::sin(angle));
  return centre + c * d + s * cross(u, d) + ((1 - c) * dot(u, d)) * u + shift;
}

Motion Motion::inverse() const {
  const Motion turn_back{{}, -angle, centre, axis};
  return {turn_back(centre) - turn_back(centre + shift), -angle, centre, axis};
}

std::array<double, 16> Motion::matrix() const {
  const Vec3 zero = (*this)({0, 0, 0});
  const Vec3 x = (*this)({1, 0, 0}) - zero, y = (*this)({0, 1, 0}) - zero, z = (*this)({0, 0, 1}) - zero;
  return {x.x, y.x, z.x, zero.x, x.y, y.y, z.y, zero.y, x.z, y.z, z.z, zero.z, 0, 0, 0, 1};
}

}  // namespace delquad
