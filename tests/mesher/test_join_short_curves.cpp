// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kSize = 0.1;

/// Two squares, [-1, 1] x [0, 1], with curves on the sides. The given numbers count from 1: between the two,
/// and from there around. The one between is of three: up to y = 0.5, 0.01 long, and the rest.
Mesh two_squares() {
  Mesh mesh = triangle_grid(16, 8, 2, 1);
  for (Vec3& p : mesh.points) {
    p.x -= 1;
    if (p.x == 0 && p.y == 0.625) p.y = 0.51;
  }
  mesh.regions = {{1, {}}, {2, {}}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double x = 0;
    for (const int v : mesh.triangles[t]) x += mesh.points[v].x;
    mesh.triangle_region[t] = x > 0 ? 1 : 0;
  }
  mesh.lines.clear();
  mesh.line_curve.clear();
  mesh.curves = {{1, {}}, {2, {}}, {3, {}}};
  for (int j = 0; j < 8; ++j) {
    mesh.lines.push_back({17 * j + 8, 17 * (j + 1) + 8});
    mesh.line_curve.push_back(j < 4 ? 0 : j == 4 ? 1 : 2);
  }
  return mesh;
}

MeshProblem problem_of(Mesh model) { return problem_of(TriangleModel{std::move(model)}, kSize); }

auto nodes_at(const MeshResult& result, const Vec3& place) {
  return std::ranges::count_if(result.mesh.points, [&](const Vec3& p) { return norm(p - place) < 1e-9; });
}

/// How many nodes there are at both ends of the short curve.
auto nodes_at_ends(const MeshProblem& problem) {
  const MeshResult result = mesh(problem, "DBCO");
  return nodes_at(result, {0, 0.5, 0}) + nodes_at(result, {0, 0.51, 0});
}

TEST(JoinShortCurves, NoNodeIsNeededWhereTwoGoOnAsOne) {
  MeshProblem problem = problem_of(two_squares());
  const MeshResult joined = mesh(problem, "DBCO");
  EXPECT_EQ(joined.metrics.values.at("n_irregular"), 0);
  EXPECT_EQ(joined.mesh.quads.size(), 200u);
  EXPECT_EQ(count_told(joined.warnings, "--simplify 0"), 1);
  for (const Vec3& p : joined.mesh.points)
    if (p.x == 0) {
      EXPECT_NEAR(std::remainder(p.y, kSize), 0, 1e-3);
    }
  problem.surface.simplify = 0;
  EXPECT_EQ(nodes_at_ends(problem), 2);
}

TEST(JoinShortCurves, LinesInsideAreStillThere) {
  Mesh model = two_squares();
  model.curves.push_back({4, {}});
  for (int i = 2; i < 6; ++i) {
    model.lines.push_back({17 * 4 + i, 17 * 4 + i + 1});
    model.line_curve.push_back(3);
  }
  const MeshProblem problem = problem_of(model);
  EXPECT_EQ(nodes_at_ends(problem), 0);
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  double length = 0;
  for (const auto& [a, b] : result.mesh.lines)
    if (result.mesh.points[a].y == 0.5 && result.mesh.points[b].y == 0.5)
      length += norm(result.mesh.points[b] - result.mesh.points[a]);
  EXPECT_NEAR(length, 0.5, 1e-9);
}

TEST(JoinShortCurves, WhatIsNamedStays) {
  Mesh named = two_squares();
  named.curves[1].names = {"weld"};
  EXPECT_EQ(nodes_at_ends(problem_of(named)), 2);

  MeshProblem divided = problem_of(two_squares());
  divided.divisions = {{"curve_2", 1, 1, 1}};
  EXPECT_EQ(nodes_at_ends(divided), 2);

  MeshProblem sized = problem_of(two_squares());
  sized.size.named = {{.name = "curve_2", .size = kSize / 2}};
  EXPECT_EQ(nodes_at_ends(sized), 2);
}

TEST(JoinShortCurves, PointsWithNamesStay) {
  Mesh model = two_squares();
  const auto at = std::ranges::find(model.points, Vec3{0, 0.5, 0});
  ASSERT_NE(at, model.points.end());
  model.named_points.push_back({static_cast<int>(at - model.points.begin()), {1, {"gauge"}}});
  EXPECT_EQ(nodes_at_ends(problem_of(model)), 1);
}

TEST(JoinShortCurves, TurnsStay) {
  Mesh bent = two_squares();
  const double slope = std::tan(0.4);
  for (Vec3& p : bent.points)
    if (p.y > 0.5) p.x += slope * (p.y - 0.5) * (1 - std::abs(p.x));
  MeshProblem problem = problem_of(bent);
  EXPECT_EQ(nodes_at(mesh(problem, "DBCO"), {0, 0.5, 0}), 1);
}

/// Eight curves of 0.125 turn by 35 degrees and more at corners that lie 0.02 beside a line.
TEST(JoinShortCurves, ChainsLoseCornersNearTheLine) {
  Mesh model = two_squares();
  for (int j = 0; j <= 8; ++j) {
    Vec3& p = model.points[17 * j + 8];
    p = {j % 2 == 1 ? 0.02 : j == 0 || j == 8 ? 0 : -0.02, j / 8.0, 0};
    if (j < 8) model.line_curve[j] = j;
  }
  model.curves.clear();
  for (int j = 0; j < 8; ++j) model.curves.push_back({j + 1, {}});
  const auto nodes_at_corners = [&](std::optional<double> tolerance, const Mesh& mesh_of) {
    MeshProblem problem = problem_of(mesh_of);
    problem.surface.simplify = tolerance;
    const MeshResult result = mesh(problem, "DBCO");
    EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
    std::ptrdiff_t nodes = 0;
    for (int j = 1; j < 8; ++j) nodes += nodes_at(result, model.points[17 * j + 8]);
    EXPECT_EQ(count_told(result.warnings, "others became one") > 0, nodes < 7);
    return nodes;
  };
  EXPECT_EQ(nodes_at_corners({}, model), 7);
  EXPECT_EQ(nodes_at_corners(0.1, model), 7);
  EXPECT_LE(nodes_at_corners(0.3, model), 1);
  model.curves[3].names = {"weld"};
  EXPECT_GE(nodes_at_corners(0.3, model), 2) << "ends of a name stay";
}

TEST(JoinShortCurves, ImagesShareTheirFateWhereLengthsAreRound) {
  // One is a quarter of the size long, its image a little less.
  Mesh model = triangle_grid(16, 8, 2, 1);
  for (Vec3& p : model.points) p.x -= 1;
  model.points[5].x = -0.475;
  model.points[11].x = 0.475 + 1e-10;
  for (std::size_t l = 0; l < model.lines.size(); ++l)
    for (const int first : {4, 11})
      if (model.lines[l] == std::array{first, first + 1}) {
        model.line_curve[l] = static_cast<int>(model.curves.size());
        model.curves.push_back({static_cast<int>(model.curves.size()) + 1, {}});
      }
  MeshProblem problem = problem_of(model);
  problem.symmetry.planes = {{{0, 0, 0}, {1, 0, 0}}};
  const MeshResult result = mesh(problem, "DBCO");
  for (const double x : {-0.5, 0.5}) EXPECT_EQ(nodes_at(result, {x, 0, 0}), 1);
}

}  // namespace
}  // namespace delquad
