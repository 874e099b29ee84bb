// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <vector>

#include "geometry/mesh/quad_topology.h"
#include "tests/support/shapes.h"

/// Quad meshes of patches made in code.
namespace delquad::testing_support {

/// nx by ny unit squares; the boundary's points run counterclockwise from (0, 0), as shapes::rectangle's do.
inline QuadPatch grid_patch(int nx, int ny) {
  QuadPatch mesh;
  mesh.points = shapes::rectangle(nx, ny, nx, ny).points;
  mesh.n_boundary = static_cast<int>(mesh.points.size());
  const auto index = [&](int i, int j) {
    if (j == 0) return i;
    if (i == nx) return nx + j;
    if (j == ny) return 2 * nx + ny - i;
    if (i == 0) return 2 * nx + 2 * ny - j;
    return mesh.n_boundary + (j - 1) * (nx - 1) + i - 1;
  };
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) mesh.points.push_back({double(i), double(j)});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      mesh.quads.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
  return mesh;
}

/// One triangle, on the boundary shapes::disk(1, 3).
inline QuadPatch triangle_patch() {
  QuadPatch mesh;
  mesh.points = shapes::disk(1, 3).points;
  mesh.triangles = {{0, 1, 2}};
  mesh.n_boundary = 3;
  return mesh;
}

/// Each interior point moved by up to `reach` in x and in y.
inline QuadPatch jittered(QuadPatch mesh, std::uint64_t seed, double reach) {
  std::mt19937_64 random(seed);
  for (std::size_t v = mesh.n_boundary; v < mesh.points.size(); ++v) {
    const double x = 2 * shapes::uniform(random) - 1, y = 2 * shapes::uniform(random) - 1;
    mesh.points[v] += reach * Vec2{x, y};
  }
  return mesh;
}

/// `n` random edges rotated, whatever becomes of the shapes.
inline QuadPatch scrambled(const QuadPatch& mesh, std::uint64_t seed, int n) {
  std::mt19937_64 random(seed);
  QuadTopology topology(mesh);
  for (int i = 0; i < n; ++i) {
    const int h = static_cast<int>(random() % (4 * topology.element_slots()));
    const bool forward = random() % 2 == 0;
    if (topology.can_rotate(h, forward)) topology.rotate(h, forward);
  }
  return topology.to_patch();
}

}  // namespace delquad::testing_support
