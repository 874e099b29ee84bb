// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/mesh/constrained_delaunay.h"
#include "tests/support/surfaces.h"

namespace delquad::testing_support {

/// A plane face whose outline passes through these corners, counterclockwise, in lines of about `fine`;
/// curves end at the corners.
inline SurfaceModel polygon_face(const std::vector<Vec2>& corners, double fine) {
  PatchBoundary outline;
  std::vector<int> corner_points;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], d = corners[(i + 1) % corners.size()] - a;
    const int n = std::max(1, static_cast<int>(std::lround(norm(d) / fine)));
    corner_points.push_back(static_cast<int>(outline.points.size()));
    for (int k = 0; k < n; ++k) outline.points.push_back(a + (double(k) / n) * d);
  }
  const int n = static_cast<int>(outline.points.size());
  for (int i = 0; i < n; ++i) outline.edges.push_back({i, (i + 1) % n});
  const TriPatch tri = constrained_delaunay(outline);
  std::vector<Vec3> points;
  for (const Vec2 p : tri.points) points.push_back({p.x, p.y, 0});
  SurfaceModel model = one_face(std::move(points), tri.triangles);
  model.corners = corner_points;
  return model;
}

}  // namespace delquad::testing_support
