#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/quad_corners.h"

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

/// Twice the area vector of an element: its length the area, where the element is flat.
inline Vec3 area_vector(const std::array<Vec3, 3>& p) { return cross(p[1] - p[0], p[2] - p[0]); }
inline Vec3 area_vector(const std::array<Vec3, 4>& p) { return cross(p[2] - p[0], p[3] - p[1]); }

/// The side from which each element of a mesh is looked at.
///
/// Where all points have the same z, it is +z or -z: the one from which more of the area of the element's
/// region runs counterclockwise. So a flat face may look down, and an element that runs against most of its
/// region is inverted. Elsewhere each element is seen from the tip of its own area vector.
class ElementSides {
 public:
  explicit ElementSides(const Mesh& mesh);
  /// Of a mesh that is seen from one side, whatever its elements do.
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
  /// Elements without a region count as of the first.
  size_t index(const std::vector<int>& regions, int element) const {
    return one_for_all_ || static_cast<size_t>(element) >= regions.size() ? 0 : regions[element];
  }

  const Mesh& mesh_;
  std::vector<Vec3> of_region_;  ///< empty: each element has its own
  bool one_for_all_ = false;
};

inline ElementShape<3> triangle_shape(const Mesh& mesh, int t, const ElementSides& sides) {
  return element_shape(corners_of(mesh, mesh.triangles[t]), sides.of_triangle(t));
}

inline ElementShape<4> quad_shape(const Mesh& mesh, int q, const ElementSides& sides) {
  return element_shape(corners_of(mesh, mesh.quads[q]), sides.of_quad(q));
}

/// How far a quad is from flat, in radians, [0, pi]: a diagonal cuts it into two triangles, whose normals
/// form an angle; the larger one of the two diagonals'. It is the angle whose cosine is the least in
/// Verdict's "warpage" [stimpson2007]. A corner of 180 degrees has no normal and counts as flat.
inline double quad_warp(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> normal;  // of the triangle at each corner
  for (size_t k = 0; k < 4; ++k) normal[k] = cross(p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k]);
  const auto angle = [](const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); };
  return std::max(angle(normal[0], normal[2]), angle(normal[1], normal[3]));
}

/// A quad is folded where quad_warp() is above this: cut along one of its diagonals, as solvers, pictures and
/// other programs do along either, it turns back on itself. All quads of eta 0 that are seen from their own
/// side are folded, but for corners of just 180 degrees; others are folded although all their angles are
/// below 180. Above a right angle by what rounding makes of one: quads around a square tube have just that.
inline constexpr double kFold = std::numbers::pi / 2 + 1e-6;  // radians

/// A quad of a larger aspect is thin. It is the reciprocal of kShortSide.
inline constexpr double kThin = 10;

/// Elements of this scaled Jacobian and less are not sound. Rounding to single precision, as many programs
/// read coordinates, moves a corner by up to 2^-24 = 6e-8 of its coordinates: that turns the sides of an
/// element a thousandth as large as these, kSingleHolds such steps, by up to so many radians.
inline constexpr double kLeastJacobian = 1e-4;
/// Elements with shorter sides, in steps of rounding, are more than single precision holds.
inline constexpr double kSingleHolds = 2e4;

/// The rounding of the largest coordinate to single precision.
template <size_t N>
double single_rounding(const std::array<Vec3, N>& corners) {
  double largest = 0;
  for (const Vec3& p : corners) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest * 0x1p-24;
}

/// The scaled Jacobian of the element once its coordinates are rounded to single precision.
template <size_t N>
double single_jacobian(std::array<Vec3, N> corners, const Vec3& normal) {
  const auto round = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  for (Vec3& p : corners) p = {round(p.x), round(p.y), round(p.z)};
  return element_shape(corners, normal).scaled_jacobian;
}

/// Whether the element is fit to be computed with: its scaled Jacobian is above kLeastJacobian, also in
/// single precision where that can hold it.
template <size_t N>
bool is_readable(const std::array<Vec3, N>& corners, const Vec3& normal, const ElementShape<N>& shape) {
  constexpr double kDoubtful = 10 * kLeastJacobian;  // more than rounding takes away
  if (shape.scaled_jacobian > kDoubtful) return true;
  if (!(shape.scaled_jacobian > kLeastJacobian)) return false;
  double shortest = norm(corners[0] - corners[N - 1]);
  for (size_t k = 1; k < N; ++k) shortest = std::min(shortest, norm(corners[k] - corners[k - 1]));
  return shortest < kSingleHolds * single_rounding(corners) ||
         single_jacobian(corners, normal) > kLeastJacobian;
}

/// Whether a quad, seen from the tip of `normal`, is readable and not folded.
inline bool is_sound_quad(const std::array<Vec3, 4>& corners, const Vec3& normal,
                          const ElementShape<4>& shape) {
  return is_readable(corners, normal, shape) && quad_warp(corners) <= kFold;
}

/// Longest over shortest side, at least 1; infinite where a side has no length [stimpson2007, edge ratio].
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
