// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "algorithms/fields/background_mesh.h"
#include "tests/support/meshing.h"

namespace delquad {

inline std::shared_ptr<const BackgroundMesh> background_of(const PatchBoundary& patch) {
  return std::make_shared<const BackgroundMesh>(std::span(&patch, 1));
}

/// Image of the rectangle [0, width] x [0, height] under a map, triangulated over a grid of squares of side
/// `step`.
inline std::shared_ptr<const BackgroundMesh> image_of_grid(double width, double height, double step,
                                                           const std::function<Vec2(Vec2)>& map) {
  const int nx = static_cast<int>(std::lround(width / step)),
            ny = static_cast<int>(std::lround(height / step));
  PatchBoundary boundary;
  shapes::add_polygon(boundary, {{0, 0}, {width, 0}, {width, height}, {0, height}}, {nx, ny, nx, ny});
  for (Vec2& p : boundary.points) p = map(p);
  std::vector<Vec2> interior;
  for (int j = 1; j < ny; ++j) {
    for (int i = 1; i < nx; ++i) interior.push_back(map({i * width / nx, j * height / ny}));
  }
  return std::make_shared<const BackgroundMesh>(constrained_delaunay(boundary, interior));
}

/// The boundary as the mesh of lines it stands for.
inline Mesh line_mesh(const PatchBoundary& patch) {
  Mesh mesh;
  for (const Vec2 p : patch.points) mesh.points.push_back({p.x, p.y, 0});
  mesh.lines = patch.edges;
  mesh.line_curve = patch.edge_curve;
  return mesh;
}

inline double area(const PatchBoundary& patch) {
  double sum = 0;
  for (const auto& [i, j] : patch.edges) sum += cross(patch.points[i], patch.points[j]) / 2;
  return sum;
}

inline double area(const TriPatch& tri, int t) {
  const auto& [i, j, k] = tri.triangles[t];
  return cross(tri.points[j] - tri.points[i], tri.points[k] - tri.points[i]) / 2;
}

inline Vec2 centroid(const TriPatch& tri, int t) {
  const auto& [i, j, k] = tri.triangles[t];
  return (1.0 / 3) * (tri.points[i] + tri.points[j] + tri.points[k]);
}

/// A point of the domain, as likely in each triangle.
inline Vec2 random_point(const TriPatch& tri, std::mt19937_64& random) {
  const auto& [i, j, k] = tri.triangles[random() % tri.triangles.size()];
  double s = shapes::uniform(random), t = shapes::uniform(random);
  if (s + t > 1) {
    s = 1 - s;
    t = 1 - t;
  }
  return tri.points[i] + s * (tri.points[j] - tri.points[i]) + t * (tri.points[k] - tri.points[i]);
}

}  // namespace delquad
