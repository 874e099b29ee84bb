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

/// Shape functions of an element and their slopes at a place.
struct Shape {
  static constexpr std::size_t kMost = (kMostOrder + 1) * (kMostOrder + 1);
  std::array<double, kMost> value, along_s, along_t;
};

/// A quadrature point of an element.
struct Quadrature {
  double s, t, weight;
};

/// Elements of a mesh, triangles first, as maps from the triangle (0, 0), (1, 0), (0, 1) and the unit square.
class Elements {
 public:
  /// With `corners_only` elements have straight sides.
  explicit Elements(const Mesh& mesh, bool corners_only = false);

  int size() const { return static_cast<int>(start_.size()) - 1; }
  bool is_triangle(int element) const { return element < n_triangles_; }
  std::span<const int> nodes(int element) const {
    return std::span(nodes_).subspan(start_[element], start_[element + 1] - start_[element]);
  }
  Shape shape(int element, double s, double t) const;
  /// Returns the shape at the element's nearest place to x, searched from a guess.
  Shape shape_at(int element, const Vec3& x, double s, double t) const;
  double value(int element, const Shape& shape, std::span<const double> values) const;
  Vec3 point(int element, const Shape& shape) const;
  /// Returns the area factor of the map, and replaces slopes along s and t by slopes in the plane.
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
    double s, t;  ///< on the element as two triangles
  };
  /// Returns the element; `hint` is -1 at first.
  Found at(const Vec3& x, int& hint) const;

 private:
  NearestTriangle triangles_;
  int n_triangles_;
};

/// Throws InputError, with the name `what`, for a mesh without elements.
void require_elements(const Mesh& mesh, const std::string& what);
/// Throws InputError if no two elements share a point, as in files of discontinuous fields.
void require_joined(const Mesh& mesh, const std::string& what);
void require_planar(const Mesh& mesh, const std::string& what);
/// Throws InputError unless each point of elements has a finite value.
void require_values(const Mesh& mesh, std::span<const double> values, const std::string& name);

}  // namespace delquad
