// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/features/given/given.h"

namespace delquad {
namespace {

/// n x n quads of [0, 1]^2, west and east of x = 1/2 regions of their own, lines around and between them.
Mesh given_grid(int n) {
  Mesh mesh;
  const auto at = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.push_back({double(i) / n, double(j) / n, 3});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      mesh.quad_region.push_back(2 * i < n ? 0 : 1);
    }
  for (int i = 0; i < n; ++i) {
    mesh.lines.insert(mesh.lines.end(), {{at(i, 0), at(i + 1, 0)},
                                         {at(n, i), at(n, i + 1)},
                                         {at(i + 1, n), at(i, n)},
                                         {at(0, i + 1), at(0, i)},
                                         {at(n / 2, i), at(n / 2, i + 1)}});
    mesh.line_curve.insert(mesh.line_curve.end(), {0, 0, 0, 0, 1});
  }
  mesh.curves = {{1, {"around"}}, {7, {"between"}}};
  mesh.regions = {{1, {"west"}}, {4, {"east"}}};
  return mesh;
}

/// Moves what is on no line.
Mesh shaken(Mesh mesh, double by) {
  std::vector<char> stays(mesh.points.size(), 0);
  for (const auto& line : mesh.lines)
    for (const int v : line) stays[v] = 1;
  std::mt19937 random(7);
  const auto draw = [&] { return by * (2 * double(random()) / double(std::mt19937::max()) - 1); };
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const double x = draw(), y = draw();
    if (stays[v] == 0) mesh.points[v] = mesh.points[v] + Vec3{x, y, 0};
  }
  return mesh;
}

using Segment = std::array<double, 4>;

/// The lines by their ends' coordinates, of each curve by its name.
std::set<std::pair<std::string, Segment>> lines_by_name(const Mesh& mesh) {
  std::set<std::pair<std::string, Segment>> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Vec3 a = mesh.points[mesh.lines[l][0]], b = mesh.points[mesh.lines[l][1]];
    const auto ends = std::minmax({std::pair{a.x, a.y}, std::pair{b.x, b.y}});
    const auto& names = mesh.curves[mesh.line_curve[l]].names;
    lines.insert({names.empty() ? "" : names[0],
                  {ends.first.first, ends.first.second, ends.second.first, ends.second.second}});
  }
  return lines;
}

void expect_kept(const Mesh& given, const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
  EXPECT_EQ(lines_by_name(result.mesh), lines_by_name(given));
  expect_same_entities(result.mesh.curves, given.curves);
  expect_same_entities(result.mesh.regions, given.regions);
}

TEST(GivenMeshes, AGridStaysWhatItIs) {
  const Mesh grid = given_grid(10);
  const MeshResult result = improve_given(grid, "CO");
  expect_kept(grid, result);
  EXPECT_EQ(result.mesh.quads.size(), 100u);
  EXPECT_NEAR(result.prepared->size.expected_quads, 100, 1);
  for (const Vec3& p : result.mesh.points) {
    EXPECT_NEAR(10 * p.x, std::round(10 * p.x), 1e-6);
    EXPECT_NEAR(10 * p.y, std::round(10 * p.y), 1e-6);
    EXPECT_EQ(p.z, 3);
  }
}

TEST(GivenMeshes, TwoQuadsWithoutAVertexInsideAreNotCalledWorse) {
  Mesh two;
  two.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2.3, 1.2, 0}};
  two.quads = {{0, 1, 4, 3}, {1, 2, 5, 4}};
  two.quad_region = {0, 0};
  two.regions = {{1, {"plate"}}};
  const MeshResult result = improve_given(two, "CO");
  EXPECT_TRUE(result.warnings.empty()) << result.warnings[0].text;
}

TEST(GivenMeshes, AShakenGridIsUntangled) {
  const Mesh grid = shaken(given_grid(10), 0.09);
  const MeshMetrics before = evaluate_metrics(grid, nullptr);
  ASSERT_EQ(before.values.at("eta_worst"), 0);
  for (const char* word : {"O", "CO"}) {
    const MeshResult result = improve_given(grid, word);
    expect_kept(grid, result);
    EXPECT_GT(result.metrics.values.at("eta_worst"), 0.5) << word;
    EXPECT_GT(result.metrics.values.at("eta_mean"), 0.9) << word;
  }
}

TEST(GivenMeshes, TrianglesAreMerged) {
  const Mesh triangles = halved(given_grid(10), 2);
  for (const char* word : {"B", "BCO", "LBCO", "GCO", "DBCO"}) {
    const MeshResult result = improve_given(triangles, word);
    expect_kept(triangles, result);
    EXPECT_EQ(result.mesh.triangles.size(), 0u) << word;
    EXPECT_GT(result.metrics.values.at("eta_mean"), 0.9) << word;
  }
  // Merging is the only thing that B can do here.
  EXPECT_EQ(improve_given(triangles, "B").mesh.quads.size(), 100u);
}

TEST(GivenMeshes, ElementsMayRunEitherWay) {
  Mesh grid = given_grid(6);
  for (auto& quad : grid.quads) std::ranges::reverse(quad);
  expect_kept(grid, improve_given(grid, "CO"));
  std::ranges::reverse(grid.quads[7]);
  const MeshResult result = improve_given(grid, "CO");
  expect_kept(grid, result);
  EXPECT_NEAR(result.metrics.values.at("eta_worst"), 1, 1e-6);
}

TEST(GivenMeshes, PointsWithNamesStay) {
  Mesh grid = given_grid(10);
  const int sensor = 3 * 11 + 3;
  grid.named_points = {{sensor, {5, {"sensor"}}}};
  grid.points[sensor] = grid.points[sensor] + Vec3{0.02, 0.03, 0};
  const MeshResult result = improve_given(grid, "CO");
  expect_kept(grid, result);
  ASSERT_EQ(result.mesh.named_points.size(), 1u);
  EXPECT_EQ(result.mesh.named_points[0].entity.names[0], "sensor");
  EXPECT_EQ(result.mesh.points[result.mesh.named_points[0].point], grid.points[sensor]);
}

/// A line of a single edge, inside a region.
TEST(GivenMeshes, LinesInsideStay) {
  Mesh grid = given_grid(10);
  grid.lines.push_back({3 * 11 + 7, 3 * 11 + 8});
  grid.line_curve.push_back(2);
  grid.curves.push_back({9, {"wire"}});
  expect_kept(grid, improve_given(shaken(grid, 0.03), "CO"));
  expect_kept(grid, improve_given(halved(grid, 2), "BCO"));
}

/// From (0.3, 0.5) to (0.7, 0.5) the nodes are there twice, but for the ends.
TEST(GivenMeshes, CracksStayOpen) {
  Mesh grid = given_grid(10);
  std::erase_if(grid.lines, [&](const auto& line) { return line[1] == line[0] + 11 && line[0] % 11 == 5; });
  grid.line_curve.assign(grid.lines.size(), 0);
  grid.quad_region.assign(100, 0);
  const int first = static_cast<int>(grid.points.size());
  for (int i = 4; i <= 6; ++i) grid.points.push_back(Vec3(grid.points[5 * 11 + i]));
  for (int q = 50; q < 60; ++q)
    for (int& v : grid.quads[q])
      if (v >= 5 * 11 + 4 && v <= 5 * 11 + 6) v += first - (5 * 11 + 4);
  for (int i = 3; i < 7; ++i) grid.lines.push_back({5 * 11 + i, 5 * 11 + i + 1});
  grid.line_curve.resize(grid.lines.size(), 1);
  const MeshResult result = improve_given(grid, "CO");
  expect_kept(grid, result);
  std::map<std::pair<double, double>, int> nodes;
  for (const Vec3& p : result.mesh.points) ++nodes[{p.x, p.y}];
  EXPECT_EQ(std::ranges::count(nodes, 2, [](const auto& n) { return n.second; }), 3);
}

TEST(GivenMeshes, AnOddOutlineKeepsItsTriangle) {
  Mesh grid = given_grid(4);
  grid.quads[0] = grid.quads.back();
  grid.quads.pop_back();
  grid.quad_region.assign(15, 0);
  grid.lines.clear();
  grid.line_curve.clear();
  // The corner at the origin was cut off.
  grid.triangles = {{1, 6, 5}};
  grid.triangle_region = {0};
  const MeshResult result = improve_given(grid, "CO");
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_EQ(result.mesh.triangles.size(), 1u);
  EXPECT_TRUE(is_reported(result.warnings, "odd number"));
}

TEST(GivenMeshes, TheWayThroughAFileIsTheSame) {
  MeshProblem problem = problem_of(
      polygons({{{0, 0}, {3, 0.3}, {2.5, 2}, {0.4, 1.7}}, {{1, 0.7}, {1.6, 0.8}, {1.2, 1.3}}}), 0.06);
  const auto whole = mesh(problem, "DBCO").metrics.values;
  const Mesh start = mesh(problem, "DB").mesh;
  problem.model = GivenMesh{start};
  problem.options.set("repair.keep_given", false);
  const MeshResult result = mesh(problem, "CO");
  expect_kept(start, result);
  const auto& halves = result.metrics.values;
  EXPECT_NEAR(halves.at("d4"), whole.at("d4"), 2);
  EXPECT_NEAR(halves.at("eta_mean"), whole.at("eta_mean"), 0.01);
  // Without a size, the size of the elements is about the size they were made for.
  problem.size = {};
  const MeshResult alone = mesh(problem, "CO");
  EXPECT_NEAR(alone.metrics.values.at("d4"), whole.at("d4"), 2);
  EXPECT_NEAR(alone.prepared->size.expected_quads, double(start.quads.size()),
              0.05 * double(start.quads.size()));
}

/// Stages from outside may do anything.
const bool kShearAdded = [] {
  add_stage({'V', "shear", PatchForm::kQuads, PatchForm::kQuads,
             [](const StageInput&, PatchMesh& patch, StageLog&) {
               QuadPatch& quads = patch.quads;
               for (std::size_t v = quads.n_boundary; v < quads.points.size(); ++v) quads.points[v].x += 0.02;
             }});
  return true;
}();

TEST(GivenMeshes, AreKeptWhereTheResultWouldBeWorse) {
  ASSERT_TRUE(kShearAdded);
  const Mesh grid = given_grid(10);
  const MeshResult result = improve_given(grid, "V");
  expect_kept(grid, result);
  EXPECT_EQ(result.metrics.values.at("eta_worst"), 1);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_TRUE(holds(result.warnings[0].text, "the given mesh is kept: the given mesh ("));
}

/// The worst angle, shortest edge and largest aspect, and the number of quads.
void expect_no_worse(const MeshResult& after, const Mesh& given) {
  const auto before = improve_given(given, "V").metrics.values;  // sheared, and so kept as it is
  const auto& now = after.metrics.values;
  constexpr double kRounding = 1e-6;
  EXPECT_GE(now.at("eta_worst"), before.at("eta_worst") - kRounding);
  EXPECT_GE(now.at("edge_min"), before.at("edge_min") - kRounding);
  EXPECT_LE(now.at("aspect_max"), before.at("aspect_max") + kRounding);
  EXPECT_NEAR(now.at("n_quads"), before.at("n_quads"), 0.1 * before.at("n_quads"));
  EXPECT_GE(now.at("eta_mean"), before.at("eta_mean"));
}

TEST(GivenMeshes, NothingGetsWorse) {
  for (const double size : {1.0, 0.7})
    for (const double gap : {0.022, 0.3, 1.5}) {
      MeshProblem problem =
          problem_of(polygons({{{0, 0}, {20, 0}, {20, 20}, {0, 20}},
                               {{5, 8}, {8, 8}, {8, 11}, {5, 11}},
                               {{8 + gap, 8.5}, {11 + gap, 8.5}, {11 + gap, 11.5}, {8 + gap, 11.5}}}),
                     size);
      const Mesh given = mesh(problem, "DB").mesh;
      for (const char* word : {"CO", "O", "CQO"}) {
        SCOPED_TRACE(std::to_string(size) + " " + std::to_string(gap) + " " + word);
        expect_no_worse(improve_given(given, word), given);
      }
    }
}

TEST(GivenMeshes, WhatGetsWorseIsTakenWhereItIsAskedFor) {
  MeshProblem problem = problem_of(GivenMesh{given_grid(10)});
  problem.options.set("repair.keep_given", false);
  const MeshResult result = mesh(problem, "V");
  EXPECT_LT(result.metrics.values.at("eta_worst"), 1);
  EXPECT_TRUE(result.warnings.empty());
}

TEST(GivenMeshes, SizesByNameHold) {
  MeshProblem problem = problem_of(GivenMesh{given_grid(10)});
  problem.size.named = {{.name = "between", .size = 0.03}};
  const MeshResult result = mesh(problem, "O");
  int hint = -1;
  EXPECT_NEAR(result.prepared->size.field->at({0.5, 0.5, 3}, hint), 0.03, 1e-9);
}

TEST(GivenMeshes, WhatCannotBeUsedIsNamed) {
  const Mesh grid = given_grid(4);
  expect_input_error([&] { improve_given(halved(grid, 2), "CO"); }, {"triangles", "B"});
  expect_input_error([&] { improve_given(shaken(halved(grid, 2), 0.3), "BCO"); },
                     {"inverted or flat", "first at"});

  Mesh hanging = grid;  // (0.25, 0.25) is a point of its own in one of its quads
  hanging.points.push_back({0.25, 0.125, 3});
  hanging.quads[0] = {0, 1, 25, 5};
  hanging.quads.push_back({25, 6, 5, 0});
  hanging.quad_region.push_back(0);
  expect_input_error([&] { improve_given(hanging, "CO"); }, {"(0.25, 0.125)", "hanging node"});
  Mesh short_edge = grid;
  short_edge.points[1] = {1e-300, 0, short_edge.points[1].z};
  expect_input_error([&] { improve_given(short_edge, "O"); }, {"has no length"});

  Mesh branching = grid;
  branching.points.push_back({0.4, 0.4, 3});
  branching.triangles = {{6, 7, 25}};
  branching.triangle_region = {0};
  expect_input_error([&] { improve_given(branching, "CO"); }, {"in 3 elements", "(0.25, 0.25, 3)"});

  // Two cones of elements that touch in their tip, one of them on top of others.
  Mesh pinched = grid;
  for (const Vec3& at : {Vec3{0.4, 0.4, 3}, Vec3{0.6, 0.4, 3}, Vec3{0.5, 0.6, 3}})
    pinched.points.push_back(at);
  pinched.triangles = {{12, 25, 26}, {12, 26, 27}, {12, 27, 25}};
  pinched.triangle_region = {0, 0, 0};
  expect_input_error([&] { improve_given(pinched, "CO"); }, {"overlap"});

  Mesh island = grid;  // a second grid lies on the first one, and shares no node
  for (const Vec3& p : grid.points) island.points.push_back({0.1 + p.x / 2, 0.1 + p.y / 2, 3});
  for (auto quad : grid.quads) {
    for (int& v : quad) v += static_cast<int>(grid.points.size());
    island.quads.push_back(quad);
  }
  island.quad_region.resize(island.quads.size(), 0);
  expect_input_error([&] { improve_given(island, "CO"); }, {"overlap"});

  // A hole of which one corner was drawn over the opposite side.
  Mesh inside_out = halved(given_grid(6), 2);
  const auto hole = std::ranges::find(inside_out.triangles, std::array{16, 17, 23});
  ASSERT_NE(hole, inside_out.triangles.end());
  inside_out.triangle_region.erase(inside_out.triangle_region.begin() +
                                   (hole - inside_out.triangles.begin()));
  inside_out.triangles.erase(hole);
  inside_out.points[16] = {0.47, 0.47, 3};
  expect_input_error([&] { improve_given(inside_out, "BCO"); }, {"turned inside out"});

  Mesh twice = grid;
  twice.quads[5] = {6, 7, 12, 12};
  expect_input_error([&] { improve_given(twice, "CO"); }, {"corner twice"});

  expect_input_error([&] { improve_given({}, "CO"); }, {"neither triangles nor quads"});
  MeshProblem lines = problem_of(polygons({{{0, 0}, {1, 0}, {0, 1}}}));
  expect_refused(lines, "CO", {"'C' starts from quads"});
}

}  // namespace
}  // namespace delquad
