// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

/// Structured meshes of [0, width] x [0, height]: curves "south", "east", "north", "west" (tags 1 to 4), one
/// region "inside" (tag 1).
namespace delquad::testing_support {

inline Mesh grid_outline(int nx, int ny, double width, double height) {
  Mesh mesh;
  const auto at = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) mesh.points.push_back({width * i / nx, height * j / ny, 0});
  }
  const auto add_line = [&](int a, int b, int curve) {
    mesh.lines.push_back({a, b});
    mesh.line_curve.push_back(curve);
  };
  for (int i = 0; i < nx; ++i) add_line(at(i, 0), at(i + 1, 0), 0);
  for (int j = 0; j < ny; ++j) add_line(at(nx, j), at(nx, j + 1), 1);
  for (int i = nx; i > 0; --i) add_line(at(i, ny), at(i - 1, ny), 2);
  for (int j = ny; j > 0; --j) add_line(at(0, j), at(0, j - 1), 3);
  mesh.curves = {{1, {"south"}}, {2, {"east"}}, {3, {"north"}}, {4, {"west"}}};
  mesh.regions = {{1, {"inside"}}};
  return mesh;
}

/// Calls f(a, d) for the cells, with their lower left and upper left points.
template <class F>
void for_each_cell(int nx, int ny, F f) {
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) f(j * (nx + 1) + i, (j + 1) * (nx + 1) + i);
}

inline Mesh quad_grid(int nx, int ny, double width = 1, double height = 1) {
  Mesh mesh = grid_outline(nx, ny, width, height);
  for_each_cell(nx, ny, [&](int a, int d) {
    mesh.quads.push_back({a, a + 1, d + 1, d});
    mesh.quad_region.push_back(0);
  });
  return mesh;
}

/// Each cell cut from its lower left to its upper right corner.
inline Mesh triangle_grid(int nx, int ny, double width = 1, double height = 1) {
  Mesh mesh = grid_outline(nx, ny, width, height);
  for_each_cell(nx, ny, [&](int a, int d) {
    mesh.triangles.push_back({a, a + 1, d + 1});
    mesh.triangles.push_back({a, d + 1, d});
    mesh.triangle_region.insert(mesh.triangle_region.end(), 2, 0);
  });
  return mesh;
}

}  // namespace delquad::testing_support
