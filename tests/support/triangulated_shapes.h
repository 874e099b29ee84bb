// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "delquad/mesh.h"

/// Closed surfaces of triangles with normals outwards, one region a side; nodes are shared.
namespace delquad::testing_support {

class TriangulatedShape {
 public:
  int point(const Vec3& p) {
    const auto rounded = [](double x) { return std::lround(x * 1e6); };
    const auto [it, is_new] = index_.emplace(std::array<long, 3>{rounded(p.x), rounded(p.y), rounded(p.z)},
                                             static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back(p);
    return it->second;
  }
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    mesh.triangles.push_back({point(a), point(b), point(c)});
    mesh.triangle_region.push_back(static_cast<int>(mesh.regions.size()) - 1);
  }
  void region() { mesh.regions.push_back({static_cast<int>(mesh.regions.size()) + 1, {}}); }

  Mesh mesh;

 private:
  std::map<std::array<long, 3>, int> index_;
};

/// The box [0, x] x [0, y] x [0, z], each side of n x n squares cut in two. Regions 1 to 6: x = 0, x, y = 0,
/// y, z = 0, z.
inline Mesh box(int n, double x = 1, double y = 1, double z = 1) {
  TriangulatedShape shape;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      shape.region();
      const auto at = [&](int i, int j) {
        std::array<double, 3> p{};
        p[axis] = side;
        p[(axis + 1) % 3] = double(side == 1 ? i : j) / n;
        p[(axis + 2) % 3] = double(side == 1 ? j : i) / n;
        return Vec3{x * p[0], y * p[1], z * p[2]};
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          shape.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
          shape.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
  }
  return shape.mesh;
}

/// A can of radius 1 and height 1: the wall is region 1, bottom and top 2 and 3.
inline Mesh can(int n_around, int n_along) {
  TriangulatedShape shape;
  const auto at = [&](int i, double z) {
    const double t = 2 * std::numbers::pi * (i % n_around) / n_around;
    return Vec3{std::cos(t), std::sin(t), z};
  };
  shape.region();
  for (int i = 0; i < n_around; ++i) {
    for (int j = 0; j < n_along; ++j) {
      const double z = double(j) / n_along, above = double(j + 1) / n_along;
      shape.triangle(at(i, z), at(i + 1, z), at(i + 1, above));
      shape.triangle(at(i, z), at(i + 1, above), at(i, above));
    }
  }
  shape.region();
  for (int i = 0; i < n_around; ++i) shape.triangle({0, 0, 0}, at(i + 1, 0), at(i, 0));
  shape.region();
  for (int i = 0; i < n_around; ++i) shape.triangle({0, 0, 1}, at(i, 1), at(i + 1, 1));
  return shape.mesh;
}

/// Two caps of paraboloids, each `height` high, on one circle of radius 1: regions 1 (above) and 2.
inline Mesh lens(int n_around, int n_rings, double height) {
  TriangulatedShape shape;
  for (const int side : {1, -1}) {
    shape.region();
    const auto at = [&](int i, int ring) {
      const double t = side * 2 * std::numbers::pi * (i % n_around) / n_around, r = double(ring) / n_rings;
      return Vec3{r * std::cos(t), r * std::sin(t), side * height * (1 - r * r)};
    };
    for (int i = 0; i < n_around; ++i) {
      shape.triangle(at(0, 0), at(i, 1), at(i + 1, 1));
      for (int j = 1; j < n_rings; ++j) {
        shape.triangle(at(i, j), at(i, j + 1), at(i + 1, j + 1));
        shape.triangle(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      }
    }
  }
  return shape.mesh;
}

/// Adds the triangles of a moved mesh, in regions of the same numbers. Returns the number of its first point.
inline int append(Mesh& mesh, const Mesh other, const Vec3& shift = {}) {
  const int n = static_cast<int>(mesh.points.size());
  for (const Vec3& p : other.points) mesh.points.push_back(p + shift);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + n, b + n, c + n});
  mesh.triangle_region.insert(mesh.triangle_region.end(), other.triangle_region.begin(),
                              other.triangle_region.end());
  return n;
}

/// All triangles in one region.
inline Mesh without_regions(Mesh mesh) {
  mesh.regions = {{1, {}}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// Each triangle with nodes of its own, as in an STL file.
inline Mesh soup(const Mesh& mesh) {
  Mesh result = mesh;
  result.points.clear();
  for (auto& v : result.triangles) {
    for (int& i : v) {
      result.points.push_back(mesh.points[i]);
      i = static_cast<int>(result.points.size()) - 1;
    }
  }
  return result;
}

}  // namespace delquad::testing_support
