// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/quad_corners.h"

// This header measures shapes of elements. Measures, soundness, criteria and repairs use it.

namespace delquad {

/// Inner angles and smallest scaled Jacobian of a triangle or quad.
template <size_t N>
struct ElementShape {
  std::array<double, N> angle;  ///< radians in [0, 2 pi]; above pi if the corner turns the wrong way
  double scaled_jacobian = 1;   ///< least signed sine of the corners; 0 if an edge has no length
};

/// Returns the shape of the element with `corners`, counterclockwise as seen from the tip of `normal`, of any
/// length.
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

/// Returns eta, 0 to 1 [paper, equation (4)]; the angles are in radians. NaN counts as the worst angle.
inline double eta_of(const std::array<double, 4>& angle) {
  double eta = 1;
  for (const double a : angle) {
    const double corner = eta_of_deviation(std::abs(std::numbers::pi / 2 - a));
    if (!(corner > 0)) return 0;
    eta = std::min(eta, corner);
  }
  return eta;
}

template <size_t N>
std::array<Vec3, N> corners_of(const Mesh& mesh, const std::array<int, N>& element) {
  std::array<Vec3, N> corners;
  for (size_t k = 0; k < N; ++k) corners[k] = mesh.points[element[k]];
  return corners;
}

/// Returns twice the area vector of an element. The length of the area vector is the area of a flat element.
inline Vec3 area_vector(const std::array<Vec3, 3>& p) { return cross(p[1] - p[0], p[2] - p[0]); }
inline Vec3 area_vector(const std::array<Vec3, 4>& p) { return cross(p[2] - p[0], p[3] - p[1]); }

/// The side from which each element of a mesh is seen.
///
/// If all points have the same z, it is +z or -z: the one from which the larger part of the region runs
/// counterclockwise. So a flat face may look down, and an element against most of its region is inverted. In
/// space each element is seen from the tip of its own area vector.
class ElementSides {
 public:
  explicit ElementSides(const Mesh& mesh);
  /// Sees all elements from one given side.
  ElementSides(const Mesh& mesh, const Vec3& side) : mesh_(mesh), of_region_(1, side), one_for_all_(true) {}

  Vec3 of_triangle(int t) const {
    return of_region_.empty() ? area_vector(corners_of(mesh_, mesh_.triangles[t]))
                              : of_region_[index(mesh_.triangle_region, t)];
  }
  Vec3 of_quad(int q) const {
    return of_region_.empty() ? area_vector(corners_of(mesh_, mesh_.quads[q]))
                              : of_region_[index(mesh_.quad_region, q)];
  }

 private:
  /// Elements without a region count as in the first one.
  size_t index(const std::vector<int>& regions, int element) const {
    return one_for_all_ || static_cast<size_t>(element) >= regions.size() ? 0 : regions[element];
  }

  const Mesh& mesh_;
  std::vector<Vec3> of_region_;  ///< by region; empty: each element has its own
  bool one_for_all_ = false;
};

inline ElementShape<3> triangle_shape(const Mesh& mesh, int t, const ElementSides& sides) {
  return element_shape(corners_of(mesh, mesh.triangles[t]), sides.of_triangle(t));
}

inline ElementShape<4> quad_shape(const Mesh& mesh, int q, const ElementSides& sides) {
  return element_shape(corners_of(mesh, mesh.quads[q]), sides.of_quad(q));
}

/// Returns the warp of a quad, radians in [0, pi]: the larger angle between normals of two triangles, over
/// both diagonals. It is the angle with the least cosine in Verdict's "warpage" [stimpson2007]. A corner of
/// 180 degrees has no normal and counts as flat.
inline double quad_warp(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> normal;  // of the triangle at each corner
  for (size_t k = 0; k < 4; ++k) normal[k] = cross(p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k]);
  const auto angle = [](const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); };
  return std::max(angle(normal[0], normal[2]), angle(normal[1], normal[3]));
}

/// A quad with a larger quad_warp() is folded. Cut along one of its diagonals, as solvers and viewers do, it
/// turns back on itself. A quad of eta 0, seen from its own side, is folded unless a corner has 180 degrees.
/// Others are folded with all angles below 180. The excess over a right angle is for rounding: quads around a
/// square tube have a right angle.
inline constexpr double kFold = std::numbers::pi / 2 + 1e-6;  // radians

/// A quad with a larger aspect is thin. It is the reciprocal of kShortSide.
inline constexpr double kThin = 10;

/// Elements need a larger scaled Jacobian to be sound. Single precision, in which many programs read
/// coordinates, moves a corner by up to 2^-24 = 6e-8 of its coordinates. That turns sides of kSingleHolds
/// such steps, a thousandth of these coordinates, by up to this many radians.
inline constexpr double kLeastJacobian = 1e-4;
/// Sides, in steps of rounding, that single precision can hold; shorter ones are too short.
inline constexpr double kSingleHolds = 2e4;

/// Returns the rounding of the largest coordinate to single precision.
template <size_t N>
double single_rounding(const std::array<Vec3, N>& corners) {
  double largest = 0;
  for (const Vec3& p : corners) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest * 0x1p-24;
}

/// Returns the scaled Jacobian of the element in single precision.
template <size_t N>
double single_jacobian(std::array<Vec3, N> corners, const Vec3& normal) {
  const auto round = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  for (Vec3& p : corners) p = {round(p.x), round(p.y), round(p.z)};
  return element_shape(corners, normal).scaled_jacobian;
}

/// Returns whether the scaled Jacobian is above kLeastJacobian, also in single precision if that can hold the
/// element.
template <size_t N>
bool is_readable(const std::array<Vec3, N>& corners, const Vec3& normal, const ElementShape<N>& shape) {
  constexpr double kDoubtful = 10 * kLeastJacobian;  // more than rounding can take away
  if (shape.scaled_jacobian > kDoubtful) return true;
  if (!(shape.scaled_jacobian > kLeastJacobian)) return false;
  double shortest = norm(corners[0] - corners[N - 1]);
  for (size_t k = 1; k < N; ++k) shortest = std::min(shortest, norm(corners[k] - corners[k - 1]));
  return shortest < kSingleHolds * single_rounding(corners) ||
         single_jacobian(corners, normal) > kLeastJacobian;
}

/// Returns whether a quad, seen from the tip of `normal`, is readable and not folded.
inline bool is_sound_quad(const std::array<Vec3, 4>& corners, const Vec3& normal,
                          const ElementShape<4>& shape) {
  return is_readable(corners, normal, shape) && quad_warp(corners) <= kFold;
}

/// Returns longest over shortest side, at least 1; infinite if a side has no length [stimpson2007, edge
/// ratio].
inline double quad_aspect(const std::array<Vec3, 4>& p) {
  double shortest = norm(p[0] - p[3]), longest = shortest;
  for (size_t k = 0; k < 3; ++k) {
    const double side = norm(p[k + 1] - p[k]);
    shortest = std::min(shortest, side);
    longest = std::max(longest, side);
  }
  return longest / shortest;
}

}  // namespace delquad
