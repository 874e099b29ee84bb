// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

EmbeddedLine crack(std::vector<Vec3> points) { return {std::move(points), "crack", "test", true}; }

/// Meshes a model with the crack open and closed. Expects as many quads, and lips that lie on each other;
/// only `tips` are there once. Returns the open mesh.
MeshResult expect_open(MeshProblem problem, std::vector<EmbeddedLine> cracks, std::size_t tips) {
  problem.surface.embed = std::move(cracks);
  const MeshResult apart = mesh(problem, "DBCO");
  EXPECT_TRUE(apart.soundness.sound()) << apart.soundness.text();
  EXPECT_TRUE(apart.mesh.triangles.empty());
  EXPECT_EQ(check_invariants(apart.mesh), std::vector<std::string>());
  EXPECT_TRUE(apart.mesh.periodic.empty());
  std::map<std::array<double, 3>, int> at;
  for (const int v : nodes_named(apart.mesh, "crack")) {
    const Vec3& x = apart.mesh.points[v];
    ++at[{x.x, x.y, x.z}];
  }
  std::size_t single = 0;
  for (const auto& [x, n] : at) single += n == 1;
  EXPECT_EQ(single, tips);
  for (EmbeddedLine& line : problem.surface.embed) line.is_crack = false;
  if (auto* planar = std::get_if<PlanarModel>(&problem.model))
    for (ModelCurve& curve : planar->curves) curve.is_crack = false;
  const MeshResult whole = mesh(problem, "DBCO");
  EXPECT_NEAR(length_named(apart.mesh, "crack"), 2 * length_named(whole.mesh, "crack"),
              1e-2 * length_named(apart.mesh, "crack"));
  return apart;
}

MeshProblem box_problem() { return problem_of(TriangleModel{box(4)}, 0.1); }

TEST(CracksOnFaces, EndInsideOrOnCurves) {
  expect_open(box_problem(), {crack({{0.2, 0.3, 1}, {0.8, 0.6, 1}})}, 2);
  expect_open(problem_of(TriangleModel{triangle_grid(4, 4)}, 0.1), {crack({{0, 0.5, 0}, {0.6, 0.5, 0}})}, 1);
}

TEST(CracksOnFaces, CrossEdgesAndEachOther) {
  expect_open(box_problem(), {crack({{0.5, 0.6, 1}, {0.5, 1, 1}, {0.5, 1, 0.5}})}, 2);
  const MeshResult cross = expect_open(
      box_problem(), {crack({{0.2, 0.5, 1}, {0.8, 0.5, 1}}), crack({{0.5, 0.2, 1}, {0.5, 0.8, 1}})}, 4);
  const auto is_middle = [](const Vec3& x) { return norm(x - Vec3{0.5, 0.5, 1}) < 1e-12; };
  EXPECT_EQ(std::ranges::count_if(cross.mesh.points, is_middle), 4);
}

TEST(CracksOnFaces, OpenIfTheyAreShorterThanTheSize) {
  const MeshResult result = expect_open(box_problem(), {crack({{0.5, 0.5, 1}, {0.53, 0.54, 1}})}, 2);
  EXPECT_GE(lines_named(result.mesh, "crack").size(), 4u);
}

TEST(CracksOnFaces, LieOnCurvedFaces) {
  const MeshResult ball = expect_open(problem_of(TriangleModel{round_sphere(24).fine}, 0.15),
                                      {crack({{1, 0, 0}, {0, 1, 0}, {0, 0.6, 0.8}})}, 2);
  EXPECT_NEAR(length_named(ball.mesh, "crack"), 2 * (std::numbers::pi / 2 + std::atan2(0.8, 0.6)), 0.05);
  MeshProblem sphere = problem_of(ExampleModel{"sphere"}, 2);
  sphere.divisions = {{.name = "crack", .edges = 6}};
  const MeshResult result = expect_open(sphere, {crack({{10, 0, 0}, {6, 8, 0}})}, 2);
  EXPECT_EQ(lines_named(result.mesh, "crack").size(), 12u);
  for (const int v : nodes_named(result.mesh, "crack")) EXPECT_NEAR(norm(result.mesh.points[v]), 10, 1e-9);
}

/// Beside a plane of symmetry, across it and on it, also shorter than the size; of triangles and planar.
TEST(CracksOnFaces, AreMirrored) {
  const std::vector<EmbeddedLine> beside{crack({{0.1, 0.3, 0}, {0.3, 0.5, 0}}),
                                         crack({{0.9, 0.3, 0}, {0.7, 0.5, 0}})},
      across{crack({{0.2, 0.6, 0}, {0.8, 0.6, 0}})}, on{crack({{0.5, 0, 0}, {0.5, 0.45, 0}})},
      small{crack({{0.5, 0.5, 0}, {0.5, 0.54, 0}})};
  const SymmetrySpec plane{{{{0.5, 0, 0}, {1, 0, 0}}}};
  for (const auto& [cracks, tips] :
       {std::pair(beside, 4u), std::pair(across, 2u), std::pair(on, 1u), std::pair(small, 2u)}) {
    MeshProblem triangles = problem_of(TriangleModel{triangle_grid(4, 4)}, 0.1);
    triangles.symmetry = plane;
    expect_open(triangles, cracks, tips);
    ModelMaker maker = ModelMaker().rectangle({0, 0}, {1, 1});
    for (const EmbeddedLine& line : cracks)
      maker.curve(make_segment({line.points[0].x, line.points[0].y}, {line.points[1].x, line.points[1].y}),
                  "crack", true);
    MeshProblem planar = maker.problem(0.1);
    planar.symmetry = plane;
    expect_open(planar, {}, tips);
  }
}

TEST(CracksOnFaces, RefuseWhatCannotBe) {
  const auto refuse = [](MeshProblem problem, std::initializer_list<const char*> parts) {
    if (problem.surface.embed.empty()) problem.surface.embed = {crack({{0.2, 0.5, 1}, {0.8, 0.5, 1}})};
    expect_refused(problem, "DB", parts);
  };
  MeshProblem problem = box_problem();
  problem.surface.embed = {crack({{0.2, 0.5, 1}})};
  refuse(problem, {"'crack' is no crack", "polyline"});
  problem.surface.embed = {crack({{0.2, 1, 1}, {0.8, 1, 1}})};
  refuse(problem, {"runs along"});
  problem = problem_of(TriangleModel{box(4)});
  problem.metric.chord = 0.01;
  refuse(problem, {"cracks do", "[not-with-a-metric]"});
  problem = box_problem();
  problem.layers = {{.on = {"crack"}, .first = 0.01, .number = 3}};
  refuse(problem, {"'crack'", "stands inside of one region, or is a crack"});
}

}  // namespace
}  // namespace delquad
