// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/leave_out_small.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A plate of 10 x 6 with a step of 0.02 in its upper side.
PlanarModel stepped_plate() {
  return ModelMaker().polygon({{0, 0}, {10, 0}, {10, 6}, {4, 6}, {4, 6.02}, {0, 6.02}}, {""}, "plate");
}

MeshResult mesh_at_1(const PlanarModel& model, double ignore_below) {
  MeshProblem problem = problem_of(model, 1);
  problem.surface.ignore_below = ignore_below;
  return mesh(problem, "DBCO");
}

double shortest_edge(const Mesh& mesh) {
  double least = 1e300;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k)
      least = std::min(least, norm(mesh.points[q[k]] - mesh.points[q[(k + 1) % 4]]));
  return least;
}

TEST(LeaveOutSmall, AStepBecomesPartOfASide) {
  std::vector<Warning> warnings;
  const PlanarModel thin = leave_out_small(stepped_plate(), {0.3, 0, {}}, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(holds(warnings[0].text, "no node at (4, 6"));
  EXPECT_EQ(thin.curves.size(), 6U) << "numbers of curves stay";
  EXPECT_EQ(thin.loops[0].curves.size(), 5U);
  EXPECT_LT(shortest_edge(mesh_at_1(stepped_plate(), 0).mesh), 0.03);
  const MeshResult result = mesh_at_1(stepped_plate(), 0.3);
  EXPECT_GT(shortest_edge(result.mesh), 0.5);
  for (const Vec3& x : result.mesh.points) EXPECT_TRUE(x.y <= 6.0 || x.x <= 4) << "nodes lie on the outline";
}

TEST(LeaveOutSmall, CornersOfAPolyline) {
  // Points of a survey, far closer than the size; only one turns sharply.
  std::vector<Vec2> points;
  for (int i = 0; i <= 40; ++i) points.push_back({0.25 * i, i == 20 ? 5 : 6 + 0.01 * (i % 2)});
  points.insert(points.end(), {{10, 0}, {0, 0}, points[0]});
  const PlanarModel model = ModelMaker().loop({make_polyline(points)});
  std::vector<Warning> warnings;
  const PlanarModel thin = leave_out_small(model, {1, 0, {}}, warnings);
  const std::vector<double> fixed = thin.curves[0].shape->fixed_parameters();
  ASSERT_FALSE(fixed.empty());
  std::vector<Vec2> nodes{thin.curves[0].shape->point(0)};
  for (const double t : fixed) nodes.push_back(thin.curves[0].shape->point(t));
  for (const Vec2 corner : {Vec2{5, 5}, {10, 0}, {0, 0}})
    EXPECT_NE(std::ranges::find(nodes, corner), nodes.end()) << corner.x << ", " << corner.y;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) EXPECT_GE(norm(nodes[i + 1] - nodes[i]), 0.7);
  EXPECT_TRUE(mesh_at_1(model, 1).soundness.sound());
}

TEST(LeaveOutSmall, HolesGoWithTheirNames) {
  ModelMaker model = ModelMaker().polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, {""}, "plate");
  model.circle({3, 3}, 0.04, "pin");
  model.circle({7, 3}, 1, "bore");
  std::vector<Warning> warnings;
  const PlanarModel closed = leave_out_small(model, {0, 1, {}}, warnings);
  EXPECT_EQ(closed.loops.size(), 2U);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(holds(warnings[1].text, "'pin' went"));
  EXPECT_EQ(leave_out_small(model, {0, 1, {false, {"pin"}}}, warnings).loops.size(), 3U);
  EXPECT_EQ(leave_out_small(model, {0, 1, {true, {}}}, warnings).loops.size(), 3U);
  const Mesh mesh = mesh_at_1(model, 0.3).mesh;
  EXPECT_GT(shortest_edge(mesh), 0.35);
  std::vector<std::string> names;
  for (const Entity& curve : mesh.curves) names.insert(names.end(), curve.names.begin(), curve.names.end());
  EXPECT_EQ(names, std::vector<std::string>{"bore"});
}

TEST(LeaveOutSmall, InclusionsTakeWhatLiesInThem) {
  ModelMaker model = ModelMaker().polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, {""}, "plate");
  model.circle({3, 3}, 0.1, "", "stone");
  model.circle({3, 3}, 0.05);
  const Mesh mesh = mesh_at_1(model, 0.7).mesh;
  ASSERT_EQ(mesh.regions.size(), 1U);
  EXPECT_EQ(mesh.regions[0].names, std::vector<std::string>{"plate"});
  EXPECT_GT(shortest_edge(mesh), 0.4);
}

TEST(LeaveOutSmall, WhatHoldsSomethingThatStaysStays) {
  ModelMaker model = ModelMaker().polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, {""}, "plate");
  model.circle({3, 3}, 0.1, "", "stone");
  model.circle({3, 3}, 0.05, "core");
  std::vector<Warning> warnings;
  EXPECT_EQ(leave_out_small(model, {0, 1, {false, {"core"}}}, warnings).loops.size(), 3U);
  EXPECT_TRUE(warnings.empty());
}

TEST(LeaveOutSmall, AHoleOfJoinedArcsGetsItsWashers) {
  ModelMaker model = ModelMaker().polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {""}, "plate");
  model.loop({make_arc({10, 10}, 3, 0, 6.2), make_arc({10, 10}, 3, 6.2, 2 * 3.14159265358979324)});
  MeshProblem problem = problem_of(model, 1);
  problem.surface.ignore_below = 0.3;
  problem.washers.push_back({.least = 5, .most = 7, .rows = 1, .edges = 20});
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_FALSE(is_reported(result.warnings, "rows"));
  const auto on_ring = std::ranges::count_if(
      result.mesh.points, [](const Vec3& x) { return std::abs(std::hypot(x.x - 10, x.y - 10) - 3) < 1e-9; });
  EXPECT_EQ(on_ring, 20);
}

TEST(LeaveOutSmall, JunctionsAndNamesStay) {
  // Two regions beside each other meet at both ends of a short curve; another one has a name of its own.
  ModelMaker model =
      ModelMaker().polygon({{0, 0}, {5, 0}, {5.1, 0}, {10, 0}, {10, 5}, {0, 5}}, {""}, "plate");
  model.curves[1].name = "probe";
  std::vector<Warning> warnings;
  const PlanarModel same = leave_out_small(model, {0.3, 0, {}}, warnings);
  EXPECT_EQ(same.loops[0].curves.size(), 6U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "short curves that stay");
}

TEST(LeaveOutSmall, ASmallPartOfAPlateIsNoHole) {
  ModelMaker model = ModelMaker().polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, {""}, "plate");
  model.circle({20, 3}, 0.1);
  std::vector<Warning> warnings;
  EXPECT_EQ(leave_out_small(model, {0, 1, {}}, warnings).loops.size(), 2U);
}

TEST(LeaveOutSmall, BesideWhatNamesCurvesByNumberItIsRefused) {
  MeshProblem problem = problem_of(stepped_plate(), 1);
  problem.surface.ignore_below = 0.3;
  problem.divisions.push_back({.name = "curve_1", .edges = 10});
  expect_refused(problem, "DB", {"cannot be left out beside numbers of edges"});
}

TEST(LeaveOutSmall, WhatTheCriteriaCallTooShort) {
  MeshProblem problem = problem_of(stepped_plate(), 1);
  problem.surface.idealize = true;
  expect_refused(problem, "DB", {"there are no criteria"});
  problem.criteria = read_criteria("batch");
  EXPECT_GT(shortest_edge(mesh(problem, "DBCO").mesh), 0.5);
}

TEST(LeaveOutSmall, NamesThatNothingHas) {
  MeshProblem problem = problem_of(stepped_plate(), 1);
  problem.surface.ignore_below = 0.3;
  problem.surface.keep = {"plat"};
  expect_refused(problem, "DB", {"'plat', which is to be kept", "plate"});
}

}  // namespace
}  // namespace delquad
