// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/planar/planar_model.h"
#include "tests/support/meshing.h"

namespace delquad {

/// The four sides of a rectangle, counterclockwise from (x0, y0).
inline std::vector<ModelMaker::Shape> rectangle_sides(double x0, double y0, double x1, double y1) {
  return {make_segment({x0, y0}, {x1, y0}), make_segment({x1, y0}, {x1, y1}),
          make_segment({x1, y1}, {x0, y1}), make_segment({x0, y1}, {x0, y0})};
}

/// A size by a function, whose values nobody checks.
class TestSize final : public SizeField {
 public:
  template <class F>
  TestSize(F size) : size_(std::move(size)) {}  // NOLINT(google-explicit-constructor)
  double at(const Vec3& x, int&) const override { return size_(x); }

 private:
  std::function<double(const Vec3&)> size_;
};

inline TestSize constant(double delta) {
  return [delta](const Vec3&) { return delta; };
}

/// Closed polygons as a line mesh, each polygon a curve of its own, named a, b, c, ...
inline Mesh polygon_lines(const std::vector<std::vector<Vec2>>& polygons) {
  Mesh mesh;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    const int base = static_cast<int>(mesh.points.size());
    const int n = static_cast<int>(polygons[k].size());
    for (int i = 0; i < n; ++i) {
      const Vec2 p = polygons[k][i];
      mesh.points.push_back({p.x, p.y, 0});
      mesh.lines.push_back({base + i, base + (i + 1) % n});
      mesh.line_curve.push_back(static_cast<int>(k));
    }
    mesh.curves.push_back({static_cast<int>(k) + 1, {std::string(1, static_cast<char>('a' + k))}});
  }
  return mesh;
}

inline std::vector<Vec2> square(double x0, double y0, double side) {
  return {{x0, y0}, {x0 + side, y0}, {x0 + side, y0 + side}, {x0, y0 + side}};
}

}  // namespace delquad
