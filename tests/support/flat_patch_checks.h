// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "base/predicates.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/surface/flatten.h"
#include "tests/support/patch_invariants.h"

namespace delquad::testing_support {

/// Lines of each curve follow each other, and curves that are not closed end at corners.
inline void expect_sound_curves(const SurfaceModel& model) {
  const Mesh& fine = model.fine;
  std::set<int> seen;
  for (std::size_t l = 0; l < fine.lines.size();) {
    const int curve = fine.line_curve[l];
    EXPECT_TRUE(seen.insert(curve).second) << "lines of curve " << curve << " are scattered";
    const std::size_t first = l++;
    for (; l < fine.lines.size() && fine.line_curve[l] == curve; ++l)
      EXPECT_EQ(fine.lines[l - 1][1], fine.lines[l][0]) << "curve " << curve;
    if (fine.lines[first][0] == fine.lines[l - 1][1]) continue;
    for (int end : {fine.lines[first][0], fine.lines[l - 1][1]})
      EXPECT_TRUE(std::ranges::binary_search(model.corners, end)) << "end of curve " << curve;
  }
  EXPECT_EQ(seen.size(), fine.curves.size());
}

/// The model is still sound, and lines bound its patches on all sides. Its patches hold each of its triangles
/// once, are one-to-one and keep areas as a whole.
inline void expect_sound_flattening(const SurfaceModel& model, const Flattening& flattening) {
  const Mesh& fine = model.fine;
  EXPECT_TRUE(flattening.failed.empty());
  EXPECT_TRUE(check_invariants(fine).empty());
  expect_sound_curves(model);
  std::set<std::pair<int, int>> lines;
  for (const auto& [a, b] : fine.lines) lines.insert(std::minmax(a, b));

  std::vector<int> uses(fine.triangles.size(), 0);
  for (const FlatPatch& p : flattening.patches) {
    EXPECT_TRUE(check_invariants(p.flat).empty());
    double flat_area = 0, area = 0;
    for (std::size_t t = 0; t < p.flat.triangles.size(); ++t) {
      ++uses[p.fine_triangle[t]];
      EXPECT_EQ(fine.triangle_region[p.fine_triangle[t]], p.face);
      const auto& v = p.flat.triangles[t];
      std::array<Vec3, 3> x;
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(p.fine_node[v[k]], fine.triangles[p.fine_triangle[t]][k]);
        x[k] = fine.points[p.fine_node[v[k]]];
        if (p.flat.neighbours[t][k] >= 0) continue;
        const int a = p.fine_node[v[(k + 1) % 3]], b = p.fine_node[v[(k + 2) % 3]];
        EXPECT_TRUE(lines.contains(std::minmax({a, b})));
      }
      const Vec2 a = p.flat.points[v[0]], b = p.flat.points[v[1]], c = p.flat.points[v[2]];
      EXPECT_EQ(orient2d(a, b, c), 1);
      flat_area += cross(b - a, c - a) / 2;
      area += norm(cross(x[1] - x[0], x[2] - x[0])) / 2;
    }
    EXPECT_NEAR(flat_area, area, 1e-9 * area);
    int n_boundary = 0;
    for (const auto& loop : p.loops)
      for (int v : loop) EXPECT_EQ(v, n_boundary++);
    EXPECT_EQ(n_boundary, p.flat.n_boundary);
  }
  EXPECT_TRUE(std::ranges::all_of(uses, [](int n) { return n == 1; }));
}

}  // namespace delquad::testing_support
