#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {

/// Shape functions of an element and their slopes at a place of it.
struct Shape {
  static constexpr std::size_t kMost = (kMostOrder + 1) * (kMostOrder + 1);
  std::array<double, kMost> value, along_s, along_t;
};

/// A place of an element that stands for a part of it.
struct Quadrature {
  double s, t, weight;
};

/// The elements of a mesh, triangles first, as maps from the triangle (0, 0), (1, 0), (0, 1) and the unit
/// square.
class Elements {
 public:
  /// `corners_only`: as if they were straight.
  explicit Elements(const Mesh& mesh, bool corners_only = false);

  int size() const { return static_cast<int>(start_.size()) - 1; }
  bool is_triangle(int element) const { return element < n_triangles_; }
  std::span<const int> nodes(int element) const {
    return std::span(nodes_).subspan(start_[element], start_[element + 1] - start_[element]);
  }
  Shape shape(int element, double s, double t) const;
  /// The place of the element whose point is nearest to x, from a guess.
  Shape shape_at(int element, const Vec3& x, double s, double t) const;
  double value(int element, const Shape& shape, std::span<const double> values) const;
  Vec3 point(int element, const Shape& shape) const;
  /// The area by which it grows, and the slopes of shape functions in the plane in place of those along s and
  /// t.
  double to_plane(int element, Shape& shape) const;
  /// Exact for products of two shape functions and a linear one with the area.
  std::span<const Quadrature> quadrature(int element) const;
  const std::vector<Vec3>& points() const { return points_; }

 private:
  std::vector<Vec3> points_;
  int n_triangles_, order_;
  std::vector<std::size_t> start_ = {0};
  std::vector<int> nodes_;
  std::vector<Quadrature> of_quads_;
};

/// Finds the element at a point, or the one that is nearest to it.
class ElementFinder {
 public:
  explicit ElementFinder(const Mesh& mesh);
  struct Found {
    int element;
    double s, t;  ///< of the element as two triangles
  };
  /// `hint`: -1 at first.
  Found at(const Vec3& x, int& hint) const;

 private:
  NearestTriangle triangles_;
  int n_triangles_;
};

/// Throw InputError for what is no mesh of elements, and no planar one; `what` names it.
void require_elements(const Mesh& mesh, const std::string& what);
/// Throws InputError where no two elements share a point, as in files of discontinuous fields.
void require_joined(const Mesh& mesh, const std::string& what);
void require_planar(const Mesh& mesh, const std::string& what);
/// Throws InputError unless there is a finite value for each point that elements have.
void require_values(const Mesh& mesh, std::span<const double> values, const std::string& name);

}  // namespace delquad
