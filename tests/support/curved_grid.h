// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "geometry/mesh/element_nodes.h"
#include "tests/support/grid_mesh.h"

namespace delquad::testing_support {

/// A grid of curved elements: nodes of common sides are there once, and all lie on a wave. In space it is
/// bent into a quarter of a tube.
inline Mesh curved_grid(int nx, int ny, int order, bool in_space) {
  const int across = nx * order + 1;
  Mesh mesh;
  mesh.order = order;
  const auto at = [&](int i, int j) { return j * across + i; };
  for (int j = 0; j <= ny * order; ++j)
    for (int i = 0; i < across; ++i) {
      const double u = static_cast<double>(i) / order, v = static_cast<double>(j) / order;
      const double x = u + 0.05 * std::sin(2 * v), y = v + 0.08 * std::sin(3 * u);
      mesh.points.push_back(in_space ? Vec3{std::cos(x / nx), std::sin(x / nx), y} : Vec3{x, y, 0});
    }
  const auto line = [&](int i, int j, int di, int dj, int curve) {
    std::vector<int> nodes{at(i, j), at(i + order * di, j + order * dj)};
    for (int k = 1; k < order; ++k) nodes.push_back(at(i + k * di, j + k * dj));
    add_line(mesh, nodes, curve);
  };
  for (int i = 0; i < nx; ++i) line(i * order, 0, 1, 0, 0);
  for (int j = 0; j < ny; ++j) line(nx * order, j * order, 0, 1, 1);
  std::vector<int> rows;
  for (int k = 0; k < (order + 1) * (order + 1); ++k) rows.push_back(k);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      std::vector<int> nodes;
      for (const int k : rows) nodes.push_back(at(i * order + k % (order + 1), j * order + k / (order + 1)));
      add_quad(mesh, nodes, rows, 2 * j / ny);
    }
  mesh.curves = {{1, {"south"}}, {2, {"east"}}};
  mesh.regions = {{1, {"lower"}}, {2, {"upper"}}};
  mesh.named_points = {{at(nx * order, 0), {1, {"corner"}}}};
  return mesh;
}

}  // namespace delquad::testing_support
