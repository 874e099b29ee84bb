// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/meshing.h"

namespace delquad::testing_support {

struct SurfaceCounts {
  int euler = 0;          ///< points - sides + triangles
  int free_sides = 0;     ///< of one triangle
  int crowded_sides = 0;  ///< of more than two
  double area = 0, volume = 0;
  double smallest_area = 0;  ///< of a triangle
};

inline SurfaceCounts count(const Mesh& mesh) {
  SurfaceCounts n;
  n.euler = static_cast<int>(mesh.points.size() + mesh.triangles.size());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    --n.euler;
    n.free_sides += edge.size() == 1;
    n.crowded_sides += edge.size() > 2;
  });
  n.smallest_area = 1e300;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
    const double area = norm(cross(q - p, r - p)) / 2;
    n.area += area;
    n.smallest_area = std::min(n.smallest_area, area);
    n.volume += dot(p, cross(q, r)) / 6;
  }
  return n;
}

/// The promises of SurfaceModel: a sound mesh, and chains in one direction from end to end. All sides between
/// faces and on the outline are lines; corners are where curves end or meet.
inline void expect_sound(const SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::vector<std::pair<int, int>> lines;
  std::vector<std::vector<int>> curves_at(mesh.points.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto& [a, b] = mesh.lines[l];
    lines.push_back(std::minmax(a, b));
    for (const int v : {a, b}) curves_at[v].push_back(mesh.line_curve[l]);
    if (l > 0 && mesh.line_curve[l] == mesh.line_curve[l - 1]) {
      EXPECT_EQ(mesh.lines[l - 1][1], a) << "line " << l << " does not continue its curve";
    }
  }
  EXPECT_TRUE(std::ranges::is_sorted(mesh.line_curve));
  std::ranges::sort(lines);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const bool between =
        edge.size() != 2 || mesh.triangle_region[edge[0].element] != mesh.triangle_region[edge[1].element];
    if (between) {
      EXPECT_TRUE(std::ranges::binary_search(lines, std::pair(edge[0].lo, edge[0].hi)))
          << edge[0].lo << ", " << edge[0].hi << " is no line";
    }
  });
  std::vector<int> corners;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto& at = curves_at[v];
    if (at.size() == 1 || at.size() > 2 || (at.size() == 2 && at[0] != at[1]))
      corners.push_back(static_cast<int>(v));
  }
  EXPECT_EQ(model.corners, corners);
  EXPECT_EQ(mesh.curves.size(), mesh.line_curve.empty() ? 0u : mesh.line_curve.back() + 1u);
}

}  // namespace delquad::testing_support
