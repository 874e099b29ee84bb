// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "base/box_tree.h"
#include "delquad/mesh.h"

// This header finds the triangle nearest to a point. Most modules use it.

namespace delquad {

/// Finds the triangle nearest to a point of space.
class NearestTriangle {
 public:
  /// Throws std::invalid_argument without triangles.
  NearestTriangle(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);

  struct Found {
    int triangle = -1;                ///< the first of several; -1: none within the reach
    std::array<double, 3> weights{};  ///< weights >= 0 of its vertices in the nearest point; sum 1
    double distance = std::numeric_limits<double>::infinity();
  };
  /// Returns the triangle nearest to x, if it is within `reach`, a length.
  Found find(const Vec3& x, double reach = std::numeric_limits<double>::infinity()) const;
  /// Returns the same without bound, faster if x is in or near triangle `guess` (-1: no guess).
  Found find_from(int guess, const Vec3& x) const;
  const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }

 private:
  /// Returns nearest_weights() in a triangle, and the square of the distance.
  std::pair<std::array<double, 3>, double> nearest_in(int t, const Vec3& x) const;

  std::vector<Vec3> points_;
  std::vector<std::array<int, 3>> triangles_;
  /// A part of a triangle with its box. Slivers have several parts, whose boxes hold fewer other triangles.
  struct Part {
    int triangle;
    Box<Vec3> box;
  };

  std::vector<Part> parts_;
  BoxTree<Vec3> tree_;
};

/// Returns the weights >= 0, with sum 1, of the vertices in the point of triangle a, b, c nearest to x.
std::array<double, 3> nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x);

}  // namespace delquad
