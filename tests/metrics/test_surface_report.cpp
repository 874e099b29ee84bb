// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangulated_model.h"
#include "metrics/surface/surface_report.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

using testing_support::box;

/// The unit cube with n x n quads a side, as a mesh of the model of box().
Mesh quad_cube(const SurfaceModel& model, int n) {
  Mesh mesh = box(n);
  mesh.curves = model.fine.curves;
  mesh.regions = model.fine.regions;
  for (std::size_t t = 0; t + 1 < mesh.triangles.size(); t += 2) {
    const auto &a = mesh.triangles[t], &b = mesh.triangles[t + 1];
    mesh.quads.push_back({a[0], a[1], a[2], b[2]});
    mesh.quad_region.push_back(mesh.triangle_region[t]);
  }
  mesh.triangles.clear();
  mesh.triangle_region.clear();
  // Both number their points alike when n is the model's, too.
  if (mesh.points == model.fine.points) {
    mesh.lines = model.fine.lines;
    mesh.line_curve = model.fine.line_curve;
  }
  return mesh;
}

class SurfaceReports : public ::testing::Test {
 protected:
  SurfaceModel model_ = make_surface_model(box(4));
  std::vector<char> none_ = std::vector<char>(6, 0);
};

TEST_F(SurfaceReports, AMeshThatFits) {
  const SurfaceReport report = report_surface(model_, {}, none_, quad_cube(model_, 4));
  EXPECT_EQ(report.mesh.euler_characteristic, 2);
  EXPECT_EQ(report.model.euler_characteristic, 2);
  EXPECT_TRUE(report.mesh.watertight());
  EXPECT_EQ(report.mesh.disagreeing_edges, 0);
  EXPECT_EQ(report.nonconforming_edges.count, 0);
  EXPECT_EQ(report.mesh_to_surface.samples, 96 + 192);
  EXPECT_LT(report.mesh_to_surface.max, 1e-15);
  EXPECT_LT(report.surface_to_mesh.max, 1e-15);
  EXPECT_EQ(report.nodes_at_corners.samples, 8);
  EXPECT_EQ(report.nodes_on_curves.samples, 12 * 3);
  EXPECT_EQ(report.nodes_in_faces.samples, 6 * 9);
  EXPECT_LT(report.nodes_in_faces.max, 1e-15);
}

TEST_F(SurfaceReports, AHoleATwistAndABranch) {
  Mesh holed = quad_cube(model_, 4);
  holed.quads.erase(holed.quads.begin() + 5);
  holed.quad_region.erase(holed.quad_region.begin() + 5);
  const SurfaceReport hole = report_surface(model_, {}, none_, holed);
  EXPECT_FALSE(hole.mesh.watertight());
  EXPECT_EQ(hole.mesh.free_edges, 4);
  EXPECT_EQ(hole.nonconforming_edges.count, 4);
  EXPECT_EQ(hole.mesh.euler_characteristic, 1);

  Mesh twisted = quad_cube(model_, 4);
  std::swap(twisted.quads[5][1], twisted.quads[5][3]);
  EXPECT_EQ(report_surface(model_, {}, none_, twisted).mesh.disagreeing_edges, 4);

  Mesh branched = quad_cube(model_, 4);
  branched.points.push_back({0.5, 0.5, 0.5});
  branched.triangles.push_back({branched.quads[0][0], branched.quads[0][1], 98});
  branched.triangle_region.push_back(0);
  const SurfaceReport branch = report_surface(model_, {}, none_, branched);
  EXPECT_EQ(branch.mesh.branching_edges, 1);
  EXPECT_EQ(branch.nonconforming_edges.count, 3);
}

TEST_F(SurfaceReports, DistancesAreInDiagonals) {
  Mesh mesh = quad_cube(model_, 4);
  for (Vec3& p : mesh.points)
    if (p.z == 1) p.z = 1.1;
  const SurfaceReport report = report_surface(model_, {}, none_, mesh);
  const double expected = 0.1 / std::sqrt(3.0);
  EXPECT_NEAR(report.mesh_to_surface.max, expected, 1e-14);
  EXPECT_NEAR(report.nodes_in_faces.max, expected, 1e-14);
  EXPECT_NEAR(report.nodes_at_corners.max, expected, 1e-14);
  EXPECT_NEAR(report.surface_to_mesh.max, expected, 1e-14);  // from the middle of the lid
  EXPECT_GT(report.surface_to_mesh.mean, expected / 20);
  EXPECT_LT(report.surface_to_mesh.mean, expected / 2);
}

TEST_F(SurfaceReports, AMissingFaceIsFarFromTheMeshUnlessLeftOut) {
  // Two large triangles a side: only samples inside them see what is missing.
  const SurfaceModel coarse = make_surface_model(box(1));
  Mesh mesh = quad_cube(coarse, 4);
  for (std::size_t i = mesh.quads.size(); i-- > 0;) {
    if (mesh.quad_region[i] != 2) continue;
    mesh.quads.erase(mesh.quads.begin() + static_cast<long>(i));
    mesh.quad_region.erase(mesh.quad_region.begin() + static_cast<long>(i));
  }
  EXPECT_GT(report_surface(coarse, {}, none_, mesh).surface_to_mesh.max, 0.25);
  std::vector<char> left_out = none_;
  left_out[2] = 1;
  const SurfaceReport report = report_surface(coarse, {}, left_out, mesh);
  EXPECT_LT(report.surface_to_mesh.max, 1e-15);
  EXPECT_EQ(report.model.free_edges, 4);
  EXPECT_EQ(report.model.euler_characteristic, report.mesh.euler_characteristic);
}

/// The unit sphere and its equator.
class Sphere : public SurfaceProjector {
 public:
  Vec3 to_face(int, const Vec3& x) const override { return (1 / norm(x)) * x; }
  Vec3 to_curve(int, const Vec3& x) const override {
    const double r = std::hypot(x.x, x.y);
    return {x.x / r, x.y / r, 0};
  }
};

TEST(SurfaceReportsOfCad, ChordsAreMeasuredAgainstTheTrueSurface) {
  // A hemisphere of n triangles around its pole; the outline is one curve.
  constexpr int n = 12;
  SurfaceModel model;
  Mesh& fine = model.fine;
  fine.points.push_back({0, 0, 1});
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n;
    fine.points.push_back({std::cos(t), std::sin(t), 0});
    fine.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    fine.triangle_region.push_back(0);
    fine.lines.push_back({1 + i, 1 + (i + 1) % n});
    fine.line_curve.push_back(0);
  }
  fine.curves = fine.regions = {{1, {}}};
  model.projector = std::make_shared<Sphere>();
  Mesh mesh = fine;
  mesh.points[1] = 1.001 * mesh.points[1];  // off the curve by 0.001
  const SurfaceReport report = report_surface(model, {}, {0}, mesh);
  const double diagonal = 3;  // of the box 2 x 2 x 1
  EXPECT_NEAR(report.nodes_on_curves.max, 0.001 / diagonal, 1e-12);
  EXPECT_NEAR(report.nodes_in_faces.max, 0, 1e-15);
  // The middle of an edge to the pole lies deepest below the sphere.
  EXPECT_NEAR(report.mesh_to_surface.max, (1 - std::sqrt(0.5)) / diagonal, 1e-9);
  EXPECT_EQ(report.nonconforming_edges.count, 0);  // the outline's edges are free in the model, too
}

TEST(MapReports, TheWorstFaceIsNamed) {
  FlatPatch good, bad;
  good.face = 3;
  good.flat.points = {{0, 0}, {2, 0}, {0, 2}};
  good.flat.triangles = {{0, 1, 2}};
  good.quality = {1.1, 1.2, 1.3, 2};
  bad.face = 7;
  bad.flat.points = {{0, 0}, {2, 0}, {0, 1}};
  bad.flat.triangles = {{0, 1, 2}};
  bad.quality = {1.4, 1.5, 1.6, 1};
  const std::vector<const FlatPatch*> maps = {&good, &bad};
  const MapReport report = report_maps(maps);
  EXPECT_EQ(report.patches.size(), 2u);
  EXPECT_EQ(report.worst_face, 7);
  EXPECT_NEAR(report.sigma_mean, (2 * 1.1 + 1.4) / 3, 1e-15);
  EXPECT_EQ(report.sigma_95, 1.5);
  EXPECT_EQ(report.sigma_max, 1.6);
  EXPECT_EQ(report.area_ratio, 2);
}

}  // namespace
}  // namespace delquad
