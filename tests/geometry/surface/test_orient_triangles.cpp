// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

/// A band of n squares around z whose section makes `turns` half turns.
Mesh band(int n, int turns) {
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n, angle = turns * t / 2;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(angle);
      mesh.points.push_back({r * std::cos(t), r * std::sin(t), s * std::sin(angle)});
    }
  }
  for (int i = 0; i < n; ++i) {
    const bool crosses = i + 1 == n && turns % 2 != 0;
    const int a = 2 * i, next = 2 * ((i + 1) % n), c = next + (crosses ? 1 : 0), d = next + (crosses ? 0 : 1);
    mesh.triangles.push_back({a, c, a + 1});
    mesh.triangles.push_back({a + 1, c, d});
  }
  mesh.regions = {{1, {}}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// Every second side of an octahedron and its three middle squares. Each edge has two of these, and no choice
/// of sides agrees at all of them.
Mesh one_sided_sheets() {
  Mesh mesh;
  mesh.points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 4, 5}, {3, 1, 5}, {3, 4, 2},  // sides
                    {0, 1, 3}, {0, 4, 3}, {1, 2, 4}, {1, 5, 4}, {2, 0, 5}, {2, 3, 5}};
  mesh.regions = {{1, {}}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return mesh;
}

TEST(OrientTriangles, SheetsThatCannotAgreeArePartedAtSharpEdges) {
  const Mesh sheets = one_sided_sheets();
  int shared = 0;
  for_each_edge(sorted_half_edges(sheets), [&](std::span<const HalfEdge> edge) {
    EXPECT_LE(edge.size(), 2u);
    shared += edge.size() == 2;
  });
  ASSERT_EQ(shared, 15);
  const SurfaceModel model = make_surface_model(sheets);
  EXPECT_EQ(violations(model), std::vector<std::string>{});
  EXPECT_EQ(model.fine.triangles.size(), sheets.triangles.size());
  EXPECT_TRUE(is_reported(model.warnings, "sides of the surface do not agree at "));
}

TEST(OrientTriangles, ASmoothBandOfOneSideIsRefused) {
  for (const int n : {40, 41})
    expect_input_error([&] { make_surface_model(band(n, 1)); }, {"one side only", "edge from ("});
  EXPECT_EQ(violations(make_surface_model(band(40, 2))), std::vector<std::string>{});
}

}  // namespace
}  // namespace delquad
