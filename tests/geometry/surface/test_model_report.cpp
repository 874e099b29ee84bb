// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/model_report.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

ModelReport report_of(const Mesh& mesh, double feature_angle = 40) {
  return report_model(make_surface_model(mesh, {.feature_angle = feature_angle}));
}

/// A flat model of one triangulated region, its outline one curve a side of the polygon.
SurfaceModel flat_model(const std::vector<Vec3>& polygon) {
  SurfaceModel model;
  const int n = static_cast<int>(polygon.size());
  model.fine.points = polygon;
  for (int i = 0; i < n; ++i) {
    model.fine.lines.push_back({i, (i + 1) % n});
    model.fine.line_curve.push_back(i);
    model.fine.curves.push_back({i + 1, {}});
    model.corners.push_back(i);
    if (i < 2) continue;
    model.fine.triangles.push_back({0, i - 1, i});
    model.fine.triangle_region.push_back(0);
  }
  model.fine.regions = {{1, {}}};
  return model;
}

TEST(ModelReport, CurvesInsideAreNoWidth) {
  // A square with a curve in its middle.
  SurfaceModel model = flat_model({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}});
  Mesh& mesh = model.fine;
  mesh.points.insert(mesh.points.end(), {{4, 5, 0}, {6, 5, 0}});
  mesh.triangles = {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {3, 0, 4}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  mesh.lines.push_back({4, 5});
  mesh.line_curve.push_back(4);
  mesh.curves.push_back({5, {}});
  model.corners.insert(model.corners.end(), {4, 5});
  EXPECT_NEAR(report_model(model).faces[0].width, 5, 1e-12) << "from the curve to the sides";
}

TEST(ModelReport, Box) {
  const ModelReport report = report_of(box(3, 1, 2, 3));
  EXPECT_EQ(report.low, (Vec3{0, 0, 0}));
  EXPECT_EQ(report.high, (Vec3{1, 2, 3}));
  EXPECT_NEAR(report.diagonal, std::sqrt(14.0), 1e-14);
  EXPECT_NEAR(report.area, 22, 1e-12);
  EXPECT_EQ(report.vertices, 8);
  EXPECT_EQ(report.free_length, 0);
  ASSERT_EQ(report.shells.size(), 1u);
  EXPECT_TRUE(report.shells[0].closed);
  EXPECT_EQ(report.shells[0].euler_characteristic, 2);
  ASSERT_EQ(report.faces.size(), 6u);
  EXPECT_EQ(report.faces[0].curves.size(), 4u);
  EXPECT_EQ(topology(report.faces[0]), "disk");
  EXPECT_NEAR(report.faces[0].area, 6, 1e-12);
  EXPECT_NEAR(report.faces[0].width, 2, 1e-12);  // 2 by 3
  ASSERT_EQ(report.curves.size(), 12u);
  double length = 0;
  for (const CurveReport& curve : report.curves) {
    EXPECT_EQ(curve.faces.size(), 2u);
    EXPECT_FALSE(curve.closed);
    length += curve.length;
  }
  EXPECT_NEAR(length, 24, 1e-12);
  ASSERT_EQ(report.corners.size(), 24u);
  for (const CornerReport& corner : report.corners) EXPECT_NEAR(corner.angle, 90, 1e-10);
}

TEST(ModelReport, CanHasAnAnnulusBetweenClosedCurves) {
  const ModelReport report = report_of(can(24, 3));
  EXPECT_EQ(topology(report.faces[0]), "annulus");
  EXPECT_EQ(topology(report.faces[1]), "disk");
  EXPECT_NEAR(report.faces[0].width, 1, 1e-12);
  EXPECT_NEAR(report.faces[1].width, 2, 0.2);  // sides look across at a slant, too
  for (const CurveReport& curve : report.curves) EXPECT_TRUE(curve.closed);
  EXPECT_TRUE(report.corners.empty());
}

TEST(ModelReport, AnOpenShellHasAnOutline) {
  Mesh mesh = box(2);
  while (mesh.triangle_region.back() == 5) {  // without its lid
    mesh.triangles.pop_back();
    mesh.triangle_region.pop_back();
  }
  mesh.regions.pop_back();
  const ModelReport report = report_of(mesh);
  EXPECT_NEAR(report.free_length, 4, 1e-12);
  EXPECT_FALSE(report.shells.at(0).closed);
  EXPECT_EQ(report.shells[0].euler_characteristic, 1);
}

TEST(ModelReport, ShellsApartAreCountedApart) {
  Mesh mesh = box(1);
  append(mesh, mesh, {3, 0, 0});
  const ModelReport report = report_of(mesh);
  ASSERT_EQ(report.shells.size(), 2u);
  for (const ShellReport& shell : report.shells) {
    EXPECT_EQ(shell.faces.size(), 6u);
    EXPECT_EQ(shell.euler_characteristic, 2);
    EXPECT_NEAR(shell.area, 6, 1e-12);
  }
}

TEST(ModelReport, ASphereWithoutCurvesIsClosed) {
  const ModelReport report = report_of(without_regions(box(2)), 180);
  ASSERT_EQ(report.faces.size(), 1u);
  EXPECT_EQ(topology(report.faces[0]), "closed");
  EXPECT_TRUE(std::isinf(report.faces[0].width));
  EXPECT_TRUE(report.shells.at(0).closed);
}

TEST(ModelReport, CornersHaveTheirAngle) {
  const double angle = 5;
  const double tip = std::tan(angle * std::numbers::pi / 180);
  const ModelReport report = report_model(flat_model({{0, 0, 0}, {10, 0, 0}, {10, 10 * tip, 0}}));
  ASSERT_EQ(report.corners.size(), 3u);
  EXPECT_NEAR(report.corners[0].angle, angle, 1e-12);
  EXPECT_EQ(report.corners[0].curves, (std::array<int, 2>{2, 0}));
  EXPECT_EQ(report.corners[0].at, (Vec3{0, 0, 0}));
  EXPECT_NEAR(report.corners[1].angle, 90, 1e-12);
  // As wide as its inscribed circle: the tip is a corner, not a narrow place.
  const double perimeter = 10 + 10 * tip + 10 / std::cos(angle * std::numbers::pi / 180);
  EXPECT_NEAR(report.faces[0].width, 4 * report.area / perimeter, 1e-12);
}

TEST(ModelReport, ANeckInALargeFaceIsFound) {
  // Two squares of side 10 joined by a strip 0.5 wide.
  SurfaceModel model = flat_model({{0, 0, 0},
                                   {10, 0, 0},
                                   {10, 4, 0},
                                   {12, 4, 0},
                                   {12, 0, 0},
                                   {22, 0, 0},
                                   {22, 10, 0},
                                   {12, 10, 0},
                                   {12, 4.5, 0},
                                   {10, 4.5, 0},
                                   {10, 10, 0},
                                   {0, 10, 0}});
  model.fine.triangles = {{0, 1, 2}, {0, 2, 9}, {0, 9, 11}, {9, 10, 11}, {2, 3, 8},
                          {2, 8, 9}, {3, 4, 5}, {3, 5, 6},  {3, 6, 8},   {6, 7, 8}};
  model.fine.triangle_region.assign(model.fine.triangles.size(), 0);
  EXPECT_NEAR(report_model(model).faces[0].width, 0.5, 1e-12);
}

}  // namespace
}  // namespace delquad
