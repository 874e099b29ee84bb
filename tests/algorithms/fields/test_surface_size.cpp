// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/surface/surface_size.h"
#include "geometry/surface/improve_triangulation.h"
#include "tests/support/meshing.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

SurfaceModel square(int n, double side) {
  return grid_surface({n, n}, [=](double u, double v) { return Vec3{side * u, side * v, 0}; });
}

WantedSize curved(const SurfaceModel& model, double base, double per_turn, double gradation = 0.3) {
  WantedSize wanted;
  wanted.base = make_constant_size(base);
  wanted.curvature = std::make_shared<ModelCurvature>(model);
  wanted.per_turn = per_turn;
  wanted.gradation = gradation;
  return wanted;
}

double size_at(const SurfaceSize& size, const Vec3& x) {
  int hint = -1;
  return size.at(x, hint);
}

TEST(SlopeLimit, GrowsFromAPointAsTheDistanceDoes) {
  const SurfaceModel model = square(20, 1);
  std::vector<double> values(model.fine.points.size(), 10);
  values[0] = 0.1;
  limit_slope(model.fine, 0.5, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double exact = 0.1 + 0.5 * norm(model.fine.points[i] - model.fine.points[0]);
    EXPECT_GE(values[i], exact - 1e-12);
    EXPECT_LE(values[i], 1.06 * exact);  // marching from a single point
  }
}

TEST(SlopeLimit, GrowsFromALineExactly) {
  const SurfaceModel model = square(10, 1);
  std::vector<double> values(model.fine.points.size(), 10);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (model.fine.points[i].x == 0) values[i] = 0.1;
  limit_slope(model.fine, 0.5, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], 0.1 + 0.5 * model.fine.points[i].x, 1e-12);
}

TEST(SlopeLimit, SheetsCloseInSpaceDoNotMix) {
  // A strip folded once: its ends lie 0.01 above each other, 2 apart along the surface.
  const SurfaceModel model = grid_surface({40, 4}, [](double u, double v) {
    const double s = 2 * u;
    return s <= 1 ? Vec3{s, 0.2 * v, 0} : Vec3{2 - s, 0.2 * v, 0.01 * (s - 1)};
  });
  std::vector<double> values(model.fine.points.size(), 1);
  int far = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Vec3& p = model.fine.points[i];
    if (p.x == 0 && p.z == 0) values[i] = 0.1;
    if (p.x == 0 && p.z > 0) far = static_cast<int>(i);
  }
  limit_slope(model.fine, 0.3, values);
  EXPECT_NEAR(values[far], 0.1 + 0.3 * 2, 0.01);
}

TEST(SurfaceSizes, AreTheBaseWhereNothingElseIsWanted) {
  SurfaceModel model = square(4, 1);
  WantedSize wanted;
  wanted.base = make_expression_size("0.1 + x");
  const std::size_t before = model.fine.points.size();
  refine_for_size(model, wanted);
  EXPECT_EQ(model.fine.points.size(), before);
  EXPECT_DOUBLE_EQ(size_at(SurfaceSize(model, wanted), {0.25, 0.5, 0}), 0.35);
}

TEST(SurfaceSizes, FollowTheCurvatureOfClosedForms) {
  const double turn = 2 * std::numbers::pi / 24;
  for (const auto& [model, radius] :
       {std::pair(round_sphere(16), 1.0), std::pair(cylinder(48, 12, 0.5, 2), 0.5),
        std::pair(torus(64, 32, 1, 0.4), 0.4)}) {
    const SurfaceSize size(model, curved(model, 2, 24));
    for (const Vec3& p : model.fine.points)
      EXPECT_NEAR(size_at(size, p), radius * turn, 0.15 * radius * turn);
  }
}

TEST(SurfaceSizes, KeepTheirLimits) {
  const SurfaceModel model = round_sphere(16);
  WantedSize wanted = curved(model, 0.1, 24);
  EXPECT_DOUBLE_EQ(size_at(SurfaceSize(model, wanted), {1, 0, 0}), 0.1) << "the base is the largest";
  wanted = curved(model, 10, 1000);
  EXPECT_DOUBLE_EQ(size_at(SurfaceSize(model, wanted), {1, 0, 0}), 0.5) << "a twentieth of the base";
  wanted.min = 0.25;
  EXPECT_DOUBLE_EQ(size_at(SurfaceSize(model, wanted), {1, 0, 0}), 0.25);
}

// A plane of two large triangles between two arcs of tiny radius, as a plane between fillets.
TEST(SurfaceSizes, APlaneBetweenSmallSizesGrowsUpToItsOwn) {
  const double r = 0.05;
  SurfaceModel model = grid_surface({14, 1}, [&](double u, double v) {
    const int i = static_cast<int>(std::lround(14 * u));
    const bool left = i < 7;
    const double angle = (left ? 6 - i : i - 8 + 1) * std::numbers::pi / 14;
    const double x = r * std::sin(angle), z = r * (std::cos(angle) - 1);
    return left ? Vec3{-1 - x, 2 * v, z} : Vec3{1 + x, 2 * v, z};
  });
  // Faces: left, plane, right.
  Mesh& mesh = model.fine;
  mesh.regions = {{1, {}}, {2, {}}, {3, {}}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double low = 1e9, high = -1e9;
    for (const int v : mesh.triangles[t]) {
      low = std::min(low, mesh.points[v].x);
      high = std::max(high, mesh.points[v].x);
    }
    mesh.triangle_region[t] = high <= -1 + 1e-12 ? 0 : low >= 1 - 1e-12 ? 2 : 1;
  }
  for (const double x : {-1.0, 1.0}) {
    std::array<int, 2> line{-1, -1};
    for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v)
      if (std::abs(mesh.points[v].x - x) < 1e-12) line[mesh.points[v].y > 1] = v;
    mesh.lines.push_back(line);
    mesh.line_curve.push_back(static_cast<int>(mesh.curves.size()));
    mesh.curves.push_back({10 + static_cast<int>(mesh.curves.size()), {}});
  }
  const WantedSize wanted = curved(model, 1, 24, 0.3);
  refine_for_size(model, wanted);
  EXPECT_GT(mesh.points.size(), 28u) << "as many as the strip has by itself";
  const SurfaceSize size(model, wanted);
  const double fillet = 2 * std::numbers::pi * r / 24;
  for (const double x : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
    const double exact = std::min(1.0, std::max(fillet, 0.05) + 0.3 * (1 - std::abs(x)));
    EXPECT_NEAR(size_at(size, {x, 1, 0}), exact, 0.25 * exact) << x;
  }
}

/// A polygon of which each side is a curve.
SurfaceModel face_of_curves(const std::vector<Vec2>& corners, double step) {
  SurfaceModel model = polygon_face(corners, step);
  Mesh& fine = model.fine;
  fine.curves.clear();
  for (std::size_t l = 0; l < fine.lines.size(); ++l) {
    if (std::ranges::find(model.corners, fine.lines[l][0]) != model.corners.end())
      fine.curves.push_back({static_cast<int>(fine.curves.size()) + 1, {}});
    fine.line_curve[l] = static_cast<int>(fine.curves.size()) - 1;
  }
  return model;
}

/// A square of side 10 with a corner cut off by an edge of this length.
SurfaceModel cut_square(double edge) {
  const double d = edge / std::numbers::sqrt2;
  return face_of_curves({{0, 0}, {10, 0}, {10, 10 - d}, {10 - d, 10}, {0, 10}}, 0.5);
}

TEST(SurfaceSizes, KeepToSpotsInsideOfLargeTriangles) {
  SurfaceModel model = square(1, 10);
  WantedSize wanted;
  wanted.base = make_constant_size(2);
  wanted.gradation = 0.7;
  wanted.spots = {{{6.3, 7.1, 0}, 0.3, 0.1}};
  improve_triangulation(model);
  refine_for_size(model, wanted);
  const SurfaceSize size(model, wanted);
  EXPECT_NEAR(size_at(size, {6.3, 7.1, 0}), 0.1, 0.03);
  EXPECT_NEAR(size_at(size, {7.3, 7.1, 0}), 0.1 + 0.7 * 0.7, 0.15);
  EXPECT_EQ(size_at(size, {1, 1, 0}), 2);
}

TEST(SizesBesideShortCurves, GrowFromAFewTimesTheirLength) {
  SurfaceModel model = cut_square(0.1);
  WantedSize wanted;
  wanted.base = make_constant_size(1);
  wanted.gradation = 0.7;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  ASSERT_EQ(wanted.curve_limit.size(), 5u);
  EXPECT_NEAR(*std::ranges::min_element(wanted.curve_limit), 0.4, 1e-9);
  refine_for_size(model, wanted);
  const SurfaceSize size(model, wanted);
  EXPECT_NEAR(size_at(size, {10, 9.95, 0}), 0.4, 0.05);
  EXPECT_NEAR(size_at(size, {10, 9.5, 0}), 0.4 + 0.7 * 0.43, 0.1);
  EXPECT_EQ(size_at(size, {10, 8, 0}), 1);
  EXPECT_EQ(size_at(size, {5, 5, 0}), 1);
}

// All points of the triangulation are ends of short curves: it has to be divided between them.
TEST(SizesBesideShortCurves, LeaveAWideFaceBetweenThemAlone) {
  constexpr double d = 0.01, kSide = 10;
  SurfaceModel model = face_of_curves({{d, 0},
                                       {kSide - d, 0},
                                       {kSide, d},
                                       {kSide, kSide - d},
                                       {kSide - d, kSide},
                                       {d, kSide},
                                       {0, kSide - d},
                                       {0, d}},
                                      100);
  ASSERT_EQ(model.fine.points.size(), 8u);
  WantedSize wanted;
  wanted.base = make_constant_size(1);
  wanted.gradation = 0.7;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  refine_for_size(model, wanted);
  const SurfaceSize size(model, wanted);
  EXPECT_NEAR(size_at(size, {d, 0, 0}), 0.057, 0.01);
  EXPECT_NEAR(size_at(size, {5, 0, 0}), 1, 0.2);
  EXPECT_NEAR(size_at(size, {5, 5, 0}), 1, 0.2);
  EXPECT_NEAR(size_at(size, {0.7, 0, 0}), 0.057 + 0.7 * 0.69, 0.15);
}

TEST(SizesBesideShortCurves, AskForNothingWhereNoneIsShort) {
  EXPECT_TRUE(sizes_beside_short_curves(cut_square(0.3).fine, *make_constant_size(1)).empty());
  const auto limit = sizes_beside_short_curves(cut_square(1e-4).fine, *make_constant_size(1));
  EXPECT_NEAR(*std::ranges::min_element(limit), 1.0 / 50, 1e-9);
}

}  // namespace
}  // namespace delquad
