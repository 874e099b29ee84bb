// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

// This header measures triangles. Surfaces, patches and CAD use it.

namespace delquad {

/// Returns twice the area of a triangle: in space as a vector along its normal, in the plane with a sign.
template <class Vec>
auto area_vector(const std::vector<Vec>& points, const std::array<int, 3>& v) {
  return cross(points[v[1]] - points[v[0]], points[v[2]] - points[v[0]]);
}
inline Vec3 area_vector(const Mesh& mesh, std::size_t triangle) {
  return area_vector(mesh.points, mesh.triangles[triangle]);
}

/// Returns the angle between two vectors, radians from 0 to pi.
inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace delquad
