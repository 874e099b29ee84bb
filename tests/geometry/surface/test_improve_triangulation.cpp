// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/improve_triangulation.h"
#include "tests/support/flat_patch_checks.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

class CylinderProjector : public SurfaceProjector {
 public:
  Vec3 to_face(int, const Vec3& x) const override {
    const double r = std::hypot(x.x, x.y);
    return {x.x / r, x.y / r, x.z};
  }
  Vec3 to_curve(int, const Vec3& x) const override { return to_face(0, x); }
};

double smallest_angle(const Mesh& mesh, double part_of_area) {
  std::vector<std::pair<double, double>> angles;
  double total = 0, sum = 0;
  for (const auto& v : mesh.triangles) {
    double least = 4, area = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.points[v[(k + 1) % 3]] - mesh.points[v[k]],
                 b = mesh.points[v[(k + 2) % 3]] - mesh.points[v[k]];
      area = norm(cross(a, b)) / 2;
      least = std::min(least, std::atan2(norm(cross(a, b)), dot(a, b)));
    }
    angles.push_back({least, area});
    total += area;
  }
  std::ranges::sort(angles);
  for (const auto& [angle, area] : angles)
    if ((sum += area) > part_of_area * total) return angle;
  return 0;
}

// What a CAD tessellation of a cylinder looks like: two triangles for each strip of the whole length.
TEST(ImproveTriangulation, DividesNeedlesOfACylinder) {
  SurfaceModel model = cylinder(40, 1, 1, 10);
  model.projector = std::make_shared<CylinderProjector>();
  ASSERT_LT(smallest_angle(model.fine, 0.01), 0.02);
  improve_triangulation(model);
  EXPECT_GT(smallest_angle(model.fine, 0.01), 0.2);
  EXPECT_LT(model.fine.triangles.size(), 6000u);
  EXPECT_TRUE(check_invariants(model.fine).empty());
  expect_sound_curves(model);
  for (const Vec3& p : model.fine.points) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-12);
}

// Facets a thousand times as long as wide, too thin for a normal of their own: the tube must not be pinched.
TEST(ImproveTriangulation, KeepsALongCylinderRound) {
  SurfaceModel model = cylinder(40, 1, 1, 200);
  model.projector = std::make_shared<CylinderProjector>();
  improve_triangulation(model);
  const std::vector<Vec3>& points = model.fine.points;
  for (const auto& v : model.fine.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 middle = 0.5 * (points[v[k]] + points[v[(k + 1) % 3]]);
      EXPECT_GT(std::hypot(middle.x, middle.y), 0.7);
    }
}

// Two tilted plane faces that share a ridge, badly triangulated: no new points, no flip across the ridge.
TEST(ImproveTriangulation, KeepsPlaneFacesAndLines) {
  SurfaceModel model;
  Mesh& fine = model.fine;
  fine.points = {{0, 0, 0}, {4, 0, 0}, {2, 0.1, 0}, {2, 3, 0}, {2, -3, 2}};
  fine.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 0, 2}, {1, 0, 4}};
  fine.triangle_region = {0, 0, 0, 1};
  fine.regions = {{1, {}}, {2, {}}};
  fine.lines = {{0, 1}, {1, 3}, {3, 0}, {0, 4}, {4, 1}};
  fine.line_curve = {0, 1, 1, 2, 2};
  fine.curves = {{1, {}}, {2, {}}, {3, {}}};
  const auto lines = fine.lines;
  improve_triangulation(model);
  EXPECT_EQ(fine.points.size(), 5u);
  EXPECT_EQ(fine.lines, lines);
}

TEST(ImproveTriangulation, FlatTrianglesAreTurnedAway) {
  SurfaceModel model = one_face({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 4, 2}, {4, 1, 2}});
  improve_triangulation(model);
  for (const auto& v : model.fine.triangles) {
    const auto& p = model.fine.points;
    EXPECT_GT(norm(cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]])), 0.5);
  }
}

// Without a surface behind them, triangles are the surface: points stay on them.
TEST(ImproveTriangulation, KeepsTriangulatedSurfaces) {
  SurfaceModel model = CubeSurface({{0, 0, 0}}, {}, 1).rounded(0);
  improve_triangulation(model);
  EXPECT_GT(model.fine.triangles.size(), 100u);
  for (const Vec3& p : model.fine.points) {
    const Vec3 q = p - Vec3{0.5, 0.5, 0.5};
    EXPECT_NEAR(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}), 0.5, 1e-12);
  }
}

}  // namespace
}  // namespace delquad
