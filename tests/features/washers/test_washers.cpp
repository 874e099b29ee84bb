// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A plate with round holes: x, y, radius.
PlanarModel plate(const std::vector<Vec3>& holes, double length = 60, double width = 40) {
  ModelMaker model =
      ModelMaker().loop({make_polyline({{0, 0}, {length, 0}, {length, width}, {0, width}, {0, 0}})});
  for (const Vec3& hole : holes) model.circle({hole.x, hole.y}, hole.z);
  return model;
}

MeshProblem problem_of(Model model, double size, std::vector<WasherSpec> washers) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.washers = std::move(washers);
  return problem;
}

/// Rows of so many quads around a center, all of whose nodes lie on circles from the hole to `radius`, to 2
/// %. If something else is there, -1.
int rows_around(const Mesh& mesh, const Vec3& centre, double hole, double radius, int rows, int edges) {
  int n = 0;
  for (const auto& quad : mesh.quads) {
    double most = 0;
    for (const int v : quad) most = std::max(most, norm(mesh.points[v] - centre));
    if (most > 1.02 * radius) continue;
    ++n;
    for (const int v : quad) {
      const double row = (norm(mesh.points[v] - centre) - hole) * rows / (radius - hole);
      if (std::abs(row - std::lround(row)) > 0.02 * radius * rows / (radius - hole)) return -1;
    }
  }
  return n % edges == 0 ? n / edges : -1;
}

TEST(Washers, AreRowsOfSoManyQuads) {
  for (const char* word : {"DB", "DBCQO"})
    for (const double size : {2.2, 4.0, 7.5}) {
      const MeshResult r =
          mesh(problem_of(plate({{20, 20, 4}, {45, 20, 1}}), size, {{6, 10, 2, 16, 4}}), word);
      EXPECT_EQ(rows_around(r.mesh, {20, 20, 0}, 4, 8, 2, 16), 2) << word << size;
      EXPECT_EQ(r.soundness.sound(), true);
      EXPECT_EQ(count_told(r.warnings, "washers"), 0);
    }
}

TEST(Washers, HaveEdgesByTheSizeWhereNoneAreGiven) {
  // Edges of 3.1 at the hole, of 5.6 around the row: 4.2 in the mean.
  const MeshResult r = mesh(problem_of(plate({{20, 20, 4}}), 4, {{6, 10}}), "DB");
  EXPECT_EQ(rows_around(r.mesh, {20, 20, 0}, 4, 4 + std::numbers::pi, 1, 8), 1);
}

TEST(Washers, AreToldWhereNoHoleMatches) {
  const std::vector<WasherSpec> washers = {{10, 12}, {7.9, 8.1}};
  EXPECT_EQ(count_told(mesh(problem_of(plate({{20, 20, 4}, {45, 20, 1}}), 4, washers), "D").warnings,
                       "no hole has a diameter from 10 to 12: holes have 2 to 8"),
            1);
  EXPECT_EQ(count_told(mesh(problem_of(plate({}), 4, {{1, 2}}), "D").warnings, "no round or slotted holes"),
            1);
  EXPECT_EQ(count_told(mesh(problem_of(ExampleModel{"sheet"}, 4, {{900, 950}}), "D").warnings,
                       "no hole has a diameter from 900 to 950"),
            1);
}

TEST(Washers, GetLessWhereThereIsNoRoom) {
  // 3 to the rim: a row of 1.5 and one that is free.
  MeshResult r = mesh(problem_of(plate({{20, 33, 4}}), 3, {{6, 10, 2, 16, 4}}), "DB");
  EXPECT_EQ(rows_around(r.mesh, {20, 33, 0}, 4, 5.5, 1, 16), 1);
  EXPECT_EQ(count_told(r.warnings, "gets 1 row of 1.5, not 2 of 2: something is 3 away"), 1);
  // Two that are 2.2 apart: between them half the length of an edge is left.
  const double row = (2.2 - std::numbers::pi / 4) / (2 + std::numbers::pi / 16);
  r = mesh(problem_of(plate({{20, 20, 4}, {30.2, 20, 4}}), 2, {{6, 10, 1, 16, 1}}), "DB");
  for (const double x : {20.0, 30.2}) EXPECT_EQ(rows_around(r.mesh, {x, 20, 0}, 4, 4 + row, 1, 16), 1);
  // None.
  r = mesh(problem_of(plate({{20, 35.5, 4}}), 2, {{6, 10, 1, 16, 2}}), "DB");
  EXPECT_EQ(count_told(r.warnings, "gets no rows: something is 0.5 away"), 1);
}

/// A planar model as triangles in space, turned about x.
Mesh in_space(const PlanarModel& model, double size) {
  Mesh made = mesh(problem_of(model, size, {}), "DB").mesh;
  for (Vec3& x : made.points) x = {x.x, 0.6 * x.y, 0.8 * x.y};
  made.lines.clear();
  made.line_curve.clear();
  made.curves.clear();
  return made;
}

double longest_side(const Mesh& mesh) {
  double longest = 0;
  for (const auto& quad : mesh.quads)
    for (const int k : {0, 1, 2, 3})
      longest = std::max(longest, norm(mesh.points[quad[k]] - mesh.points[quad[(k + 1) % 4]]));
  return longest;
}

TEST(Washers, HaveOtherEdgesWhereTheseDoNotFitTheSize) {
  for (const bool is_surface : {false, true}) {
    MeshProblem problem = problem_of(plate({{20, 20, 4}}), 1, {{6, 10, 2, 16, 4}});
    if (is_surface) problem.model = TriangleModel{in_space(plate({{20, 20, 4}}), 1.5)};
    const MeshResult r = mesh(problem, "DBCO");
    EXPECT_EQ(count_told(r.warnings, "16 edges would be 1.6 to 3.1 sizes long"), 1);
    EXPECT_LT(longest_side(r.mesh), 2.1);
  }
}

TEST(Washers, GiveTheirEdgesToTheOtherEndOfABore) {
  // The bore of 18 through the boss has room for rows at x = 0 alone.
  const MeshResult r = mesh(problem_of(ExampleModel{"bracket"}, 4, {{17, 19, 1, 24, 5.5}}), "DBCO");
  EXPECT_EQ(count_told(r.warnings, "gets no rows: something is 6 away"), 1);
  int at_first = 0, at_other = 0, all = 0;
  for (const Vec3& x : r.mesh.points) {
    if (std::abs(std::hypot(x.y - 30, x.z - 40) - 9) > 1e-3 || x.x > 16.001) continue;
    at_first += x.x < 1e-6;
    at_other += x.x > 16 - 1e-6;
    ++all;
  }
  EXPECT_EQ(at_first, 24);
  EXPECT_EQ(at_other, 24);
  EXPECT_EQ(all % 24, 0) << all;
}

TEST(Washers, OfSlotsGoAroundTheirEnds) {
  PlanarModel model = polygons({{{0, 0}, {60, 0}, {60, 40}, {0, 40}}});
  const int first = static_cast<int>(model.curves.size());
  for (const auto& shape : {make_arc({40, 20}, 4, -std::numbers::pi / 2, std::numbers::pi / 2),
                            make_segment({20, 16}, {40, 16}), make_segment({20, 24}, {40, 24}),
                            make_arc({20, 20}, 4, 0.5 * std::numbers::pi, 1.5 * std::numbers::pi)})
    model.curves.push_back({.shape = shape, .name = "", .where = "slot"});
  model.loops.push_back({.curves = {first, first + 1, first + 2, first + 3}, .region = "", .where = "slot"});
  const MeshResult r = mesh(problem_of(model, 4, {{7.9, 8.1, 1, 20, 3}}), "DBCO");
  const auto distance = [](const Vec3& x) { return norm(x - Vec3{std::clamp(x.x, 20.0, 40.0), 20, 0}) - 4; };
  int on_hole = 0, on_ring = 0, between = 0;
  for (const Vec3& x : r.mesh.points) {
    on_hole += std::abs(distance(x)) < 1e-6;
    on_ring += std::abs(distance(x) - 3) < 0.3;
    between += distance(x) > 1e-6 && distance(x) < 2.5;
  }
  EXPECT_EQ(on_hole, 20);
  EXPECT_EQ(on_ring, 20);
  EXPECT_EQ(between, 0);
}

TEST(Washers, AreRingsOnTriangulations) {
  const TriangleModel model{in_space(plate({{20, 20, 4}, {40, 20, 4}, {50, 35, 2}}), 1.5)};
  const MeshResult r = mesh(problem_of(model, 4, {{7, 9, 2, 16, 4}}), "DBCO");
  for (const double x : {20.0, 40.0}) EXPECT_EQ(rows_around(r.mesh, {x, 12, 16}, 4, 8, 2, 16), 2);
  EXPECT_TRUE(r.mesh.triangles.empty());
  EXPECT_TRUE(r.soundness.sound());
}

TEST(Washers, AreRingsAroundCoarseHoles) {
  // Eight sides: each point is a corner of the triangulation.
  const TriangleModel model{in_space(plate({{20, 20, 4}}), 3.2)};
  const MeshResult r = mesh(problem_of(model, 3, {{7, 9, 1, 16, 3}}), "DBCO");
  EXPECT_EQ(count_told(r.warnings, "rows"), 0);
  EXPECT_GT(r.metrics.values.at("eta_worst"), 0.4);
}

TEST(Washers, AreRingsOnCad) {
  // The round holes are 10 wide; two are 0.2 apart.
  const MeshResult r = mesh(problem_of(ExampleModel{"sheet"}, 4, {{9, 11, 1, 12, 3}}), "DBCO");
  for (const double y : {18.0, 42.0}) EXPECT_EQ(rows_around(r.mesh, {25, y, 0}, 5, 8, 1, 12), 1);
  EXPECT_EQ(count_told(r.warnings, "gets no rows: something is 0.2 away"), 2);
  EXPECT_EQ(r.mesh.regions.size(), 3u) << "rows are no faces";
  EXPECT_EQ(r.log.summaries.number("layers", "quads"), 24);
  EXPECT_TRUE(r.soundness.sound());
}

TEST(Washers, GoAroundHolesOfWavyFaces) {
  const MeshResult r = mesh(problem_of(ExampleModel{"free_form"}, 6, {{5, 40, 2}}), "DB");
  EXPECT_EQ(count_told(r.warnings, "gets no rows"), 0);
  EXPECT_EQ(r.log.summaries.number("layers", "quads"), 2 * r.log.summaries.number("layers", "columns"));
  EXPECT_TRUE(r.soundness.sound());
}

TEST(Washers, KeepNumbersOfEdgesThatAreGiven) {
  MeshProblem planar = problem_of(plate({{20, 20, 4}}), 3, {{6, 10, 1, 12, 3}});
  planar.divisions = {{"curve_2", 18}};
  EXPECT_EQ(rows_around(mesh(planar, "DB").mesh, {20, 20, 0}, 4, 7, 1, 18), 1);
  MeshProblem surface = problem_of(ExampleModel{"sheet"}, 3, {{9, 11, 1, 12, 3}});
  for (const char* curve : {"curve_7", "curve_8", "curve_9", "curve_10"})
    surface.divisions.push_back({curve, 18});
  const Mesh made = mesh(surface, "DB").mesh;
  for (const double y : {18.0, 42.0}) EXPECT_EQ(rows_around(made, {25, y, 0}, 5, 8, 1, 18), 1);
}

TEST(Washers, FollowCurvatureUnlessTheirEdgesAreGiven) {
  MeshProblem problem = problem_of(ExampleModel{"sheet"}, 4, {{9, 11}});
  problem.size.curvature = 16;
  const MeshResult r = mesh(problem, "DBQO");
  for (const double y : {18.0, 42.0}) EXPECT_GT(rows_around(r.mesh, {25, y, 0}, 5, 6.96, 1, 16), 0);
  EXPECT_EQ(count_told(r.warnings, "edges, not 10: curvature asks for more than the size"), 4);
  EXPECT_LT(r.mesh.quads.size(), 900u);
  EXPECT_GT(r.metrics.values.at("eta_mean"), 0.9);
  problem.washers = {{9, 11, 1, 12, 3}};
  const MeshResult given = mesh(problem, "DB");
  for (const double y : {18.0, 42.0}) EXPECT_EQ(rows_around(given.mesh, {25, y, 0}, 5, 8, 1, 12), 1);
  EXPECT_EQ(
      count_told(given.warnings, "gets 12 edges, not 16: edges that are given count more than curvature"), 4);
  MeshProblem planar = problem_of(plate({{20, 20, 4}}), 4, {{6, 10}});
  planar.size.curvature = 16;
  EXPECT_EQ(rows_around(mesh(planar, "DB").mesh, {20, 20, 0}, 4, 4 + std::numbers::pi / 2, 1, 16), 1);
}

TEST(Washers, AreRefinedWithTheirEdges) {
  MeshProblem problem = problem_of(plate({{20, 20, 4}}), 4, {{6, 10, 1, 12, 3}});
  problem.refine = 2;
  EXPECT_EQ(rows_around(mesh(problem, "DB").mesh, {20, 20, 0}, 4, 7, 2, 24), 2);
}

TEST(Washers, AreRefusedWithOneMessage) {
  const auto refuse = [](std::vector<WasherSpec> washers, std::initializer_list<const char*> parts) {
    expect_refused(problem_of(plate({{20, 20, 4}}), 4, washers), "DB", parts);
  };
  refuse({{6, 10, 1, 13}}, {"washers", "13 edges", "an even number"});
  refuse({{6, 10, 0}}, {"'rows' is 0", "1 to 1000"});
  refuse({{6, 10, -2}}, {"'rows' is -2"});
  refuse({{10, 6}}, {"diameters from 10 to 6"});
  refuse({{6, 10}, {8, 12}}, {"diameters from 8 to 12 overlap those from 6 to 10"});
  refuse({{6, 10, 1, 8, -1}}, {"'width' is -1"});
  MeshProblem fillets = problem_of(plate({{20, 20, 4}}), 4, {});
  fillets.fillet_rows = {{1, 2, 2}};
  expect_refused(fillets, "DB", {"fillet_rows", "CAD"});
  MeshProblem symmetric = problem_of(ExampleModel{"bracket"}, 4, {{6, 10}});
  symmetric.symmetry.automatic = true;
  expect_refused(symmetric, "DB", {"washers", "symmetry"});
}

TEST(FilletRows, AreRowsAcrossRoundEdges) {
  // The foot's two corners have a radius of 10, the boss's fillet is a ring of 3.
  MeshProblem problem = problem_of(ExampleModel{"bracket"}, 5, {});
  problem.fillet_rows = {{2.9, 3.1, 2}, {9.9, 10.1, 3}};
  const MeshResult r = mesh(problem, "DB");
  std::map<std::string, int> edges;
  std::set<int> rows;
  for (std::size_t l = 0; l < r.mesh.lines.size(); ++l) {
    const Vec3 a = r.mesh.points[r.mesh.lines[l][0]], b = r.mesh.points[r.mesh.lines[l][1]];
    // Arcs of the foot's corners at its bottom.
    const auto is_on = [](const Vec3& x, double y) {
      return x.z < 1e-6 && std::abs(norm(x - Vec3{70, y, 0}) - 10) < 1e-4;
    };
    for (const double y : {10.0, 50.0})
      if (is_on(a, y) && is_on(b, y)) ++edges[std::to_string(y)];
  }
  EXPECT_EQ(edges.size(), 2u);
  for (const auto& [y, n] : edges) EXPECT_EQ(n, 3) << y;
  // Nodes of the ring lie at three heights above the plate.
  std::set<long> heights;
  for (const Vec3& x : r.mesh.points)
    if (x.x > 8 - 1e-6 && x.x < 11 + 1e-6) {
      const double radius = std::hypot(x.y - 30, x.z - 40);
      if (radius > 15 - 1e-6 && radius < 18 + 1e-6) heights.insert(std::lround(100 * x.x));
    }
  EXPECT_EQ(heights.size(), 3u);
}

TEST(FillHoles, ClosesThoseThatAreNotWider) {
  MeshProblem problem = problem_of(ExampleModel{"sheet"}, 4, {});
  problem.surface.fill_holes = 0.5;
  const MeshResult r = mesh(problem, "DB");
  EXPECT_EQ(count_told(r.warnings, "closed a hole of"), 1);
  EXPECT_EQ(r.surface->mesh.euler_characteristic, 1 - 5);
  problem.surface.fill_holes = 1e-3;
  EXPECT_EQ(count_told(mesh(problem, "D").warnings, "no hole up to a diameter of 0.001 is filled"), 1);
}

}  // namespace
}  // namespace delquad
