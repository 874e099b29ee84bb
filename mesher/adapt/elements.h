// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/nearest_triangle.h"

// This header evaluates fields on elements. Recovery, estimates and transfer use it.

namespace delquad {

/// Shape functions of an element and their slopes at a place, by node.
struct Shape {
  static constexpr std::size_t kMost = (kMostOrder + 1) * (kMostOrder + 1);
  std::array<double, kMost> value, along_s, along_t;
};

/// A quadrature point of an element, in [0, 1]; weights sum up to the area of its domain.
struct Quadrature {
  double s, t, weight;
};

/// Elements of a mesh, triangles first, as maps from the triangle (0, 0), (1, 0), (0, 1) and the unit square.
class ElementMaps {
 public:
  /// With `corners_only` elements have straight sides.
  explicit ElementMaps(const Mesh& mesh, bool corners_only = false);

  int size() const { return static_cast<int>(start_.size()) - 1; }
  bool is_triangle(int element) const { return element < n_triangles_; }
  std::span<const int> nodes(int element) const {
    return std::span(nodes_).subspan(start_[element], start_[element + 1] - start_[element]);
  }
  /// Returns the shape functions at (s, t) of an element's domain: Lagrange polynomials on equal parts.
  Shape shape(int element, double s, double t) const;
  /// Returns the shape at the element's nearest place to x, by Newton's method from the guess (s, t); there
  /// if it fails.
  Shape shape_at(int element, const Vec3& x, double s, double t) const;
  /// Returns a field with these values at points, or a point of space, at a place.
  double value(int element, const Shape& shape, std::span<const double> values) const;
  Vec3 point(int element, const Shape& shape) const;
  /// Returns the area factor >= 0 of the map to the xy-plane, and replaces slopes along s and t by slopes
  /// along x and y.
  double to_plane(int element, Shape& shape) const;
  /// Returns points that are exact for products of two shape functions, a linear one and the area factor.
  std::span<const Quadrature> quadrature(int element) const;
  const std::vector<Vec3>& points() const { return points_; }

 private:
  std::vector<Vec3> points_;
  int n_triangles_, order_;
  std::vector<std::size_t> start_ = {0};
  std::vector<int> nodes_;
  std::vector<Quadrature> of_quads_;
};

/// Search for the element at a point, or the nearest one.
class ElementFinder {
 public:
  explicit ElementFinder(const Mesh& mesh);
  struct Found {
    int element;
    double s, t;  ///< place in the element's domain, exact for straight triangles only
  };
  /// Returns the element at x, or the nearest one; `hint` is -1 at first.
  Found at(const Vec3& x, int& hint) const;

 private:
  NearestTriangle triangles_;
  int n_triangles_;
};

/// Throws InputError, with the name `what`, for a mesh that is not readable or has no elements.
void require_elements(const Mesh& mesh, const std::string& what);
/// Throws InputError if no two elements share a point, as in files of discontinuous fields.
void require_joined(const Mesh& mesh, const std::string& what);
/// Throws InputError also if the elements have different z.
void require_planar(const Mesh& mesh, const std::string& what);
/// Throws InputError unless there is a value for each point, finite at nodes of elements.
void require_values(const Mesh& mesh, std::span<const double> values, const std::string& name);

}  // namespace delquad
