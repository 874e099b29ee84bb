// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Three unit squares that meet along the first curve; each of the two triangles of one turns over its
/// diagonal.
SurfaceModel three_pages() {
  SurfaceModel model;
  Mesh& mesh = model.fine;
  mesh.points = {{0, 0, 0}, {0, 1, 0}};
  mesh.lines = {{0, 1}};
  mesh.line_curve = {0};
  mesh.curves = {{1, {}}};
  for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}}) {
    const int n = static_cast<int>(mesh.points.size());
    mesh.points.push_back(mesh.points[0] + side);
    mesh.points.push_back(mesh.points[1] + side);
    mesh.regions.push_back({static_cast<int>(mesh.regions.size()) + 1, {}});
    for (const std::array<int, 3>& v : {std::array{0, n, n + 1}, std::array{0, n + 1, 1}}) {
      mesh.triangles.push_back(v);
      mesh.triangle_region.push_back(static_cast<int>(mesh.regions.size()) - 1);
    }
    for (const std::array<int, 2>& v : {std::array{0, n}, std::array{n, n + 1}, std::array{n + 1, 1}}) {
      mesh.curves.push_back({static_cast<int>(mesh.curves.size()) + 1, {}});
      mesh.lines.push_back(v);
      mesh.line_curve.push_back(static_cast<int>(mesh.curves.size()) - 1);
    }
  }
  for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v) model.corners.push_back(v);
  return model;
}

TEST(BranchingSurface, FacesShareTheirCurvesNodes) {
  const MeshResult result = meshed(three_pages(), 0.25, "DB");
  EXPECT_EQ(result.mesh.quads.size(), 3u * 16);
  EXPECT_TRUE(result.mesh.triangles.empty());
  ASSERT_TRUE(result.surface);
  EXPECT_EQ(result.surface->nonconforming_edges.count, 0);
  EXPECT_EQ(result.surface->mesh.branching_edges, 4);
  EXPECT_EQ(result.surface->mesh.euler_characteristic, result.surface->model.euler_characteristic);
}

}  // namespace
}  // namespace delquad
