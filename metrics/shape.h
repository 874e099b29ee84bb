#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "mesh/mesh.h"

namespace delquad {

/// Inner angles of a triangle or quad and its smallest scaled Jacobian.
template <size_t N>
struct ElementShape {
  std::array<double, N> angle;  ///< radians, [0, 2 pi]; a corner that turns the wrong way is above pi
  double scaled_jacobian =
      1;  ///< least over the corners of sin(angle), signed; 0 where an edge has no length
};

/// Shape of the element through `corners`, which should run counterclockwise seen from the tip of `normal`.
template <size_t N>
ElementShape<N> element_shape(const std::array<Vec3, N>& corners, const Vec3& normal) {
  ElementShape<N> shape;
  const double n = norm(normal);
  for (size_t k = 0; k < N; ++k) {
    const Vec3 out = corners[(k + 1) % N] - corners[k], in = corners[(k + N - 1) % N] - corners[k];
    const Vec3 c = cross(out, in);
    const double sine = norm(c), side = dot(c, normal);
    const double angle = std::atan2(sine, dot(out, in));
    shape.angle[k] = sine > 0 && !(side > 0) ? 2 * std::numbers::pi - angle : angle;
    const double jacobian = side / (norm(out) * norm(in) * n);
    shape.scaled_jacobian = std::min(shape.scaled_jacobian, std::isfinite(jacobian) ? jacobian : 0);
  }
  return shape;
}

/// eta, equation (4). Not a number counts as the worst.
inline double eta_of(const std::array<double, 4>& angle) {
  double eta = 1;
  for (const double a : angle) {
    const double corner = 1 - std::abs(std::numbers::pi / 2 - a) * 2 / std::numbers::pi;
    if (!(corner > 0)) return 0;
    eta = std::min(eta, corner);
  }
  return eta;
}

/// The side from which elements are looked at: +z when all z are equal, none (each element's own) otherwise.
inline std::optional<Vec3> common_normal(const Mesh& mesh) {
  for (const Vec3& p : mesh.points) {
    if (p.z != mesh.points[0].z) return std::nullopt;
  }
  return Vec3{0, 0, 1};
}

inline ElementShape<3> triangle_shape(const Mesh& mesh, int t, const std::optional<Vec3>& normal) {
  const auto& v = mesh.triangles[t];
  const std::array<Vec3, 3> p = {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
  return element_shape(p, normal ? *normal : cross(p[1] - p[0], p[2] - p[0]));
}

inline ElementShape<4> quad_shape(const Mesh& mesh, int q, const std::optional<Vec3>& normal) {
  const auto& v = mesh.quads[q];
  const std::array<Vec3, 4> p = {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
  return element_shape(p, normal ? *normal : cross(p[2] - p[0], p[3] - p[1]));
}

}  // namespace delquad
