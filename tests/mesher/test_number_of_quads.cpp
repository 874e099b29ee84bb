// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/activity.h"
#include "base/calibration.h"
#include "base/estimate.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A square with a hole, of which the curves have names.
MeshProblem plate_of_quads() {
  MeshProblem problem = problem_of(ModelMaker()
                                       .loop({make_polyline({{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}})})
                                       .circle({2, 1.5}, 0.5, "hole"));
  problem.name = problem.where = "plate";
  return problem;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quads, b.quads);
}

double size_at(const Prepared& prepared, const Vec3& x) {
  int hint = -1;
  return prepared->size.field->at(x, hint);
}

/// A mesh divided by two has the same bytes as a mesh that is asked for at half of everything.
TEST(Refine, DividesEverySize) {
  MeshProblem asked = plate_of_quads(), half = plate_of_quads();
  asked.size = {.text = "0.3 + 0.05*x",
                .sources = {{{0, 0, 0}, {0, 0, 0}, 0.1, 0.4, 0.2, 2}},
                .named = {{.name = "hole", .size = 0.1, .reach = 0.2, .growth = 0.4, .where = "hole"}},
                .gradation = 0.2,
                .max = 0.35};
  half.size = {.text = "0.15 + 0.025*x",
               .sources = {{{0, 0, 0}, {0, 0, 0}, 0.05, 0.2, 0.2, 2}},
               .named = {{.name = "hole", .size = 0.05, .reach = 0.2, .growth = 0.2, .where = "hole"}},
               .gradation = 0.1,
               .max = 0.175};
  asked.refine = 2;
  expect_equal(mesh(asked, "DB").mesh, mesh(half, "DB").mesh);
  asked.size = {.function = [](std::span<const Vec3> points, std::span<double> delta) {
    for (std::size_t i = 0; i < points.size(); ++i) delta[i] = 0.2 + 0.1 * points[i].y;
  }};
  asked.refine = 1;
  const Prepared coarse = prepare(asked);
  asked.refine = 3;
  const Prepared fine = prepare(asked);
  for (const Vec3& x : {Vec3{0.1, 0.1, 0}, Vec3{3.2, 1.1, 0}, Vec3{2, 2.7, 0}})
    EXPECT_NEAR(size_at(coarse, x) / size_at(fine, x), 3, 0.03);
  EXPECT_EQ(fine.problem().refine, 1) << "its sizes are those that it has";
  expect_equal(mesh(prepare(fine.problem()), "DB").mesh, mesh(fine, "DB").mesh);
}

TEST(Refine, DividesSizesByCurvature) {
  MeshProblem problem = problem_of(ExampleModel{"pipe_tee"});
  problem.size = {.text = "4", .curvature = 12};
  MeshProblem half = problem;
  half.size = {.text = "2", .gradation = kCurvatureGradation / 2, .curvature = 24};
  problem.refine = 2;
  expect_equal(mesh(problem, "DB").mesh, mesh(half, "DB").mesh);
  problem.refine = 0.01;
  EXPECT_EQ(prepare(problem).problem().size.curvature, kLeastPerTurn);
}

TEST(Refine, MakesKSquaredAsManyQuads) {
  for (const double k : {0.5, 1.5, 3.0}) {
    MeshProblem problem = plate_of_quads(), surface;
    surface.model = TriangleModel{box(1)};
    problem.size.text = surface.size.text = "0.05";
    for (MeshProblem p : {problem, surface}) {
      const double before = count_of_quads(mesh(p).mesh);
      p.refine = k;
      EXPECT_NEAR(count_of_quads(mesh(p).mesh) / (k * k * before), 1, 0.04) << k;
    }
  }
}

/// Edges and rows of a refined mesh lie in the edges and rows of the one before.
TEST(Refine, DividesEdgesAndLayers) {
  MeshProblem problem = plate_of_quads();
  problem.size.text = "0.3";
  problem.divisions = {{.name = "hole", .edges = 12, .progression = 1.1, .where = "hole"}};
  const Prepared coarse = prepare(problem);
  problem.refine = 2;
  const Prepared fine = prepare(problem);
  EXPECT_EQ(fine.problem().divisions[0].edges, 24);
  std::size_t found = 0, nodes = 0;
  const Mesh &few = coarse->boundary, &many = fine->boundary;
  for (const Vec3& x : few.points) {
    if (std::abs(std::hypot(x.x - 2, x.y - 1.5) - 0.5) > 1e-9) continue;
    ++nodes;
    for (const Vec3& y : many.points) found += norm(x - y) < 1e-9;
  }
  EXPECT_EQ(nodes, 12u);
  EXPECT_EQ(found, nodes);

  problem.divisions.clear();
  problem.layers = {{.on = {"hole"}, .first = 0.01, .growth = 1.3, .thickness = 0.05, .where = "hole"}};
  const std::vector<double> rows = layer_heights(problem.layers[0]);
  for (const double k : {2.0, 3.0}) {
    problem.refine = k;
    const std::vector<double> thin = layer_heights(prepare(problem).problem().layers[0]);
    ASSERT_EQ(static_cast<double>(thin.size()), k * static_cast<double>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_NEAR(thin[static_cast<std::size_t>(k) * (i + 1) - 1], rows[i], 1e-12);
  }
}

TEST(Refine, RefusesWhatItCannotDo) {
  MeshProblem problem = plate_of_quads();
  problem.size.text = "0.3";
  for (const double k : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    problem.refine = k;
    expect_input_error([&] { prepare(problem); }, {"plate", "refine"});
  }
  problem.refine = 2;
  problem.divisions = {{.name = "hole", .edges = 0, .where = "hole"}};
  expect_input_error([&] { prepare(problem); }, {"'edges' of 'hole' is 0"});
  problem.divisions.clear();
  problem.quads = 100;
  expect_input_error([&] { prepare(problem); }, {"plate", "refine", "quads", "one of both"});
  problem.quads.reset();
  problem.model = LineModel{prepare(problem)->boundary, {}, "outline.msh"};
  expect_input_error([&] { prepare(problem); }, {"outline.msh", "refine 2", "kept", "curves"});
  problem.refine = 1;
  problem.quads = 100;
  expect_input_error([&] { prepare(problem); }, {"outline.msh", "100 quads", "kept"});
}

void expect_quads(const MeshProblem& problem, const std::string& word) {
  const MeshResult result = mesh(problem, word);
  const auto wanted = static_cast<double>(*problem.quads);
  EXPECT_NEAR(count_of_quads(result.mesh) / wanted, 1, 0.03) << problem.name << " " << word;
  EXPECT_EQ(result.log.summaries.number("number_of_quads", "asked"), wanted);
  EXPECT_LE(result.log.summaries.number("number_of_quads", "meshes"), 3);
}

TEST(NumberOfQuads, IsMetWithoutASize) {
  MeshProblem surface = plate_of_quads();
  surface.name = "box";
  surface.model = TriangleModel{box(1)};
  MeshProblem cad = plate_of_quads();
  cad.name = "bracket";
  cad.model = ExampleModel{"bracket"};
  for (const auto& [model, numbers] :
       {std::pair(plate_of_quads(), std::array{800, 3000}),
        std::pair(surface, std::array{6 * 12 * 12, 6 * 22 * 22}), std::pair(cad, std::array{1500, 3000})})
    for (const int wanted : numbers) {
      MeshProblem problem = model;
      problem.quads = wanted;
      expect_quads(problem, "DB");
    }
  for (const char* quality : {"fast", "good", "best", "regular"}) {
    MeshProblem problem = plate_of_quads();
    problem.quads = 2500;
    expect_quads(problem, quality);
  }
  cad.quads = 1000;
  cad.order = 2;
  expect_quads(cad, "DBC");
  cad.order = 1;
  expect_quads(cad, "D");  // triangles, each half a quad
}

/// Sizes of a problem say where quads are small; there are as many whatever their scale.
TEST(NumberOfQuads, KeepsWhatSizesSay) {
  for (const char* size : {"0.01 + 0.02*x", "1 + 2*x"}) {
    MeshProblem problem = plate_of_quads();
    problem.quads = 2000;
    problem.size.text = size;
    expect_quads(problem, "DB");
    const Prepared prepared = prepare(problem);
    EXPECT_NEAR(size_at(prepared, {4, 1, 0}) / size_at(prepared, {0.5, 1, 0}), 4.5, 1e-9);
  }
}

TEST(NumberOfQuads, CountsLayersAndGrids) {
  MeshProblem problem = plate_of_quads();
  problem.quads = 3000;
  problem.layers = {{.on = {"hole"}, .first = 0.001, .growth = 1.2, .number = 12, .where = "hole"}};
  expect_quads(problem, "good");
  EXPECT_EQ(prepare(problem).problem().layers[0].number, 12) << "what was asked for stays";
  problem.model = polygons({{{0, 0}, {4, 0}, {4, 3}, {0, 3}}});
  problem.layers.clear();
  problem.mapped.automatic = true;
  expect_quads(problem, "good");
}

TEST(NumberOfQuads, SaysWhereItIsOutOfReach) {
  MeshProblem problem = problem_of(ExampleModel{"bracket"});
  problem.name = problem.where = "flange";
  problem.quads = 4;
  const MeshResult result = mesh(problem, "DB");
  EXPECT_GT(count_of_quads(result.mesh), 8);
  EXPECT_TRUE(result.soundness.accepted());
  EXPECT_TRUE(is_reported(result.warnings, "flange: 4 quads were asked for"));
  // A box has six times a square of an even number.
  problem.model = TriangleModel{box(1)};
  problem.quads = 800;
  const MeshResult near = mesh(problem, "DB");
  EXPECT_EQ(count_of_quads(near.mesh), 6 * 12 * 12);
  EXPECT_TRUE(is_reported(near.warnings, "has 864"));
}

TEST(NumberOfQuads, RefusesNumbersThatCannotBe) {
  MeshProblem problem = plate_of_quads();
  for (const long long n : {0LL, -5LL, 60'000'000LL}) {
    problem.quads = n;
    expect_input_error([&] { prepare(problem); }, {"plate", "quads", "1 to 50000000"});
  }
}

TEST(ExpectedQuads, AreToldBeforeTheMapsAreMade) {
  TriangleModel ball;
  ball.mesh = round_sphere(5).fine;
  std::vector<std::string> stages, before;
  double told = 0;
  Activities activities(1);
  activities.on_stage = [&](const char* name) { stages.emplace_back(name); };
  const RunScope run({.activities = &activities});
  on_estimate() = [&](double quads) {
    if (std::exchange(told, quads) == 0) before = stages;
  };
  prepare(problem_of(ball, 0.1));
  on_estimate() = nullptr;
  EXPECT_NEAR(told, 400 * std::numbers::pi, 30);
  EXPECT_EQ(std::ranges::count(before, "maps"), 0);
  EXPECT_EQ(std::ranges::count(stages, "maps"), 1);
}

}  // namespace
}  // namespace delquad
