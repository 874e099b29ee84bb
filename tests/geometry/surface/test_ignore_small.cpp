// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/ignore_small.h"
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

constexpr double kLength = 0.05;

/// Regions 1 and 2 are bottom (z = 0) and top, then one for each side of the convex polygon.
Mesh prism(const std::vector<Vec2>& polygon, double height) {
  TriangulatedShape shape;
  const auto at = [&](std::size_t i, double z) {
    const Vec2 p = polygon[i % polygon.size()];
    return Vec3{p.x, p.y, z};
  };
  shape.region();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) shape.triangle(at(0, 0), at(i + 1, 0), at(i, 0));
  shape.region();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    shape.triangle(at(0, height), at(i, height), at(i + 1, height));
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    shape.region();
    shape.triangle(at(i, 0), at(i + 1, 0), at(i + 1, height));
    shape.triangle(at(i, 0), at(i + 1, height), at(i, height));
  }
  return shape.mesh;
}

SurfaceModel model_of(Mesh mesh) { return make_surface_model(std::move(mesh), {.feature_angle = 30}); }

std::vector<std::string> new_texts(const SurfaceModel& before, const SurfaceModel& after) {
  std::vector<std::string> all = texts(after.warnings);
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(before.warnings.size()));
  return all;
}

bool has_text(const std::vector<std::string>& all, const std::string& part) {
  return std::ranges::any_of(all, [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

TEST(IgnoreSmall, LeavesWhatIsLargerAlone) {
  const SurfaceModel model = model_of(box(2));
  const SurfaceModel same = ignore_small(model, {kLength});
  EXPECT_EQ(same.fine.points, model.fine.points);
  EXPECT_EQ(same.fine.triangles, model.fine.triangles);
  EXPECT_EQ(same.fine.lines, model.fine.lines);
  EXPECT_EQ(same.corners, model.corners);
  EXPECT_EQ(same.warnings.size(), model.warnings.size());
}

TEST(IgnoreSmall, LengthsBeyondTheModelAreRefused) {
  const SurfaceModel model = make_surface_model(box(1), {.source = "box.stl"});
  expect_input_error([&] { ignore_small(model, {2}); }, {"box.stl", "2", "1.73"});
}

TEST(IgnoreSmall, TheRimOfAPlateBecomesPartOfIt) {
  Mesh mesh = box(3, 1, 1, 0.01);
  mesh.regions[4].names = {"lower"};
  mesh.regions[5].names = {"upper"};
  mesh.regions[0].names = {"rim"};
  const SurfaceModel model = model_of(mesh);
  const SurfaceModel plate = ignore_small(model, {kLength});
  expect_counts(plate, 2, 4, 4);
  for (const Entity& face : plate.fine.regions) EXPECT_EQ(face.names.size(), 1u) << "the rim's name went on";
  const auto said = new_texts(model, plate);
  EXPECT_EQ(std::ranges::count_if(said, [](const auto& s) { return s.find("became part of") != s.npos; }), 4);
  EXPECT_TRUE(has_text(said, "face 1 (rim), 0.0099 wide, became part of face 5 (lower)")) << said[0];
}

TEST(IgnoreSmall, AChamferGoesWithItsShortCurves) {
  const SurfaceModel model = model_of(prism({{0, 0}, {1, 0}, {1, 0.99}, {0.99, 1}, {0, 1}}, 1));
  expect_counts(model, 7, 15, 10);
  const SurfaceModel brick = ignore_small(model, {kLength});
  expect_counts(brick, 6, 12, 8);
  EXPECT_NEAR(volume(brick.fine), 1, 0.02);
  const auto said = new_texts(model, brick);
  EXPECT_EQ(std::ranges::count_if(said, [](const auto& s) { return s.find("became a point") != s.npos; }), 2);
}

TEST(IgnoreSmall, ShortCurvesAtTheEndOfAWedgeBecomePoints) {
  // A wedge whose edge is cut off: a face 0.01 wide and 1 high, between two long ones.
  const SurfaceModel model = model_of(prism({{0, 0}, {1, -0.005}, {1, 0.005}}, 1));
  const SurfaceModel wedge = ignore_small(model, {0.012});
  EXPECT_EQ(violations(wedge), std::vector<std::string>{});
  EXPECT_LT(wedge.fine.regions.size(), model.fine.regions.size());
}

/// The unit cube with an octagonal hole of this radius in its top, region 2, which goes down to `depth`.
/// Region 7 is its wall, region 8 its bottom when it does not go through. Regions 3 to 6 are sides, 1 is the
/// bottom.
Mesh cube_with_hole(double radius, double depth) {
  TriangulatedShape shape;
  const auto outer = [](int i, double z) {
    constexpr std::array<double, 8> kX = {0, 0.5, 1, 1, 1, 0.5, 0, 0}, kY = {0, 0, 0, 0.5, 1, 1, 1, 0.5};
    return Vec3{kX[i % 8], kY[i % 8], z};
  };
  const auto inner = [&](int i, double z) {
    const double angle = (i % 8 - 3) * std::numbers::pi / 4;
    return Vec3{0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle), z};
  };
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    shape.triangle(a, b, c);
    shape.triangle(a, c, d);
  };
  const bool through = depth >= 1;
  shape.region();
  for (int i = 0; i < 8; ++i)
    if (through)
      quad(outer(i + 1, 0), outer(i, 0), inner(i, 0), inner(i + 1, 0));
    else
      shape.triangle(outer(i + 1, 0), outer(i, 0), {0.5, 0.5, 0});
  shape.region();
  for (int i = 0; i < 8; ++i) quad(outer(i, 1), outer(i + 1, 1), inner(i + 1, 1), inner(i, 1));
  for (int i = 0; i < 8; ++i) {
    if (i % 2 == 0) shape.region();
    quad(outer(i, 0), outer(i + 1, 0), outer(i + 1, 1), outer(i, 1));
  }
  const double low = 1 - std::min(depth, 1.0);
  shape.region();
  for (int i = 0; i < 8; ++i) quad(inner(i + 1, low), inner(i, low), inner(i, 1), inner(i + 1, 1));
  if (through) return shape.mesh;
  shape.region();
  for (int i = 0; i < 8; ++i) shape.triangle(inner(i, low), inner(i + 1, low), {0.5, 0.5, low});
  return shape.mesh;
}

void expect_hole_closes(const Mesh& mesh, std::size_t faces) {
  const SurfaceModel model = make_surface_model(mesh, {.feature_angle = 60});
  EXPECT_EQ(model.fine.regions.size(), faces);
  const SurfaceModel cube = ignore_small(model, {kLength});
  expect_counts(cube, 6, 12, 8);
  EXPECT_NEAR(volume(cube.fine), 1, 1e-12);
  EXPECT_TRUE(has_text(new_texts(model, cube), "face 2: closed a hole of 0.0306 around"));
}

TEST(IgnoreSmall, HolesTubesAndPocketsAreClosed) {
  expect_hole_closes(cube_with_hole(0.005, 1), 7);
  expect_hole_closes(cube_with_hole(0.005, 0.5), 8);
}

/// Two tetrahedra that touch at the point 0; with a line at it in the first one, in both, or in none.
SurfaceModel touching_tetrahedra(const std::vector<std::array<int, 2>>& lines) {
  SurfaceModel model;
  Mesh& mesh = model.fine;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
  for (const int n : {1, 4})
    for (const auto& [a, b, c] :
         {std::array{0, n + 1, n}, {0, n + 2, n + 1}, {0, n, n + 2}, {n, n + 1, n + 2}})
      mesh.triangles.push_back({a, b, c});
  mesh.triangle_region = {0, 0, 0, 0, 1, 1, 1, 1};
  mesh.regions = {{1, {}}, {2, {}}};
  mesh.lines = lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    mesh.line_curve.push_back(static_cast<int>(i));
    mesh.curves.push_back({static_cast<int>(i) + 1, {}});
  }
  return model;
}

TEST(TidyModel, BodiesThatTouchWhereNoCurveIsArePartedThere) {
  for (const auto& [lines, points] : {std::pair<std::vector<std::array<int, 2>>, std::size_t>{{}, 8},
                                      {{{0, 1}}, 8},
                                      {{{0, 4}}, 8},
                                      {{{0, 1}, {0, 4}}, 7}}) {
    SurfaceModel model = touching_tetrahedra(lines);
    tidy_model(model, Mesh(model.fine));
    EXPECT_EQ(model.fine.points.size(), points);
    EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  }
}

TEST(IgnoreSmall, LargerHolesStay) {
  const SurfaceModel model = make_surface_model(cube_with_hole(0.01, 1), {.feature_angle = 60});
  const SurfaceModel same = ignore_small(model, {kLength});
  EXPECT_EQ(same.fine.triangles, model.fine.triangles);
}

TEST(IgnoreSmall, WhatIsSmallAltogetherIsNoHole) {
  const SurfaceModel cube = model_of(box(1));
  EXPECT_EQ(close_small_holes(cube, {100}).fine.triangles, cube.fine.triangles);
  const SurfaceModel square = make_surface_model(triangle_grid(2, 2));
  EXPECT_EQ(close_small_holes(square, {100}).fine.triangles, square.fine.triangles);
}

/// Two squares joined by a neck 0.01 wide, each a face.
Mesh neck() {
  TriangulatedShape shape;
  const Vec3 low{0, -0.005, 0}, high{0, 0.005, 0};
  shape.region();
  shape.triangle({-1, -1, 0}, low, high);
  shape.triangle({-1, -1, 0}, high, {-1, 1, 0});
  shape.region();
  shape.triangle({1, -1, 0}, high, low);
  shape.triangle({1, -1, 0}, {1, 1, 0}, high);
  return shape.mesh;
}

TEST(IgnoreSmall, ANeckIsNotTorn) {
  const SurfaceModel model = model_of(neck());
  const SurfaceModel same = ignore_small(model, {kLength});
  EXPECT_EQ(same.fine.triangles, model.fine.triangles);
  EXPECT_TRUE(has_text(new_texts(model, same), "0.01 long, stays"));
}

}  // namespace
}  // namespace delquad
