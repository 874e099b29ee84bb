// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/half_edges.h"
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

TEST(Layers, HeightsAreAGeometricSeries) {
  LayerSpec spec = layer_on({"a"}, 0.1, 3, 2);
  EXPECT_EQ(layer_heights(spec), (std::vector<double>{0.1, 0.1 + 0.2, 0.1 + 0.2 + 0.4}));
  spec.number = 0;
  spec.thickness = 0.31;
  EXPECT_EQ(layer_heights(spec).size(), 3u);  // 0.1 + 0.2 do not reach it
  spec.growth = 1;
  spec.thickness = 0.4;
  EXPECT_EQ(layer_heights(spec).size(), 4u);
}

TEST(Layers, HoleInAPlate) {
  const MeshProblem problem = ModelMaker()
                                  .rectangle({0, 0}, {2, 1}, {"south", "east", "north", "west"})
                                  .circle({0.8, 0.5}, 0.2, "hole")
                                  .problem(0.06, {layer_on({"hole"}, 1e-4, 20)});
  for (const char* word : {"DB", "DBCO", "FB", "PBCO", "DLB"}) {
    SCOPED_TRACE(word);
    const MeshResult result = mesh(problem, word);
    expect_layers(problem, result);
    EXPECT_EQ(result.log.summaries.get<double>("layers", "least_scale"), 1.0);
    for (const double h : first_heights(result.mesh, "hole")) EXPECT_NEAR(h, 1e-4, 2e-6);
  }
}

TEST(Layers, CornersOfAnLHaveBisectorsAndAFan) {
  const MeshProblem problem = ModelMaker()
                                  .polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {"wall"})
                                  .problem(0.06, {layer_on({"wall"}, 1e-3, 10, 1.3)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  EXPECT_EQ(count_of(result, "fans"), 1);
  EXPECT_EQ(result.log.summaries.get<double>("layers", "least_scale"), 1.0);
}

TEST(Layers, EndsLieOnWalls) {
  const MeshProblem problem =
      ModelMaker()
          .polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {"s", "e", "layer", "layer", "n", "w"})
          .problem(0.06, {layer_on({"layer"}, 1e-3, 10)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  // Nodes of the wall at the heights of the layers, exactly on it.
  const std::vector<double> heights = layer_heights(problem.layers[0]);
  std::vector<double> found;
  for (const int v : nodes_named(result.mesh, "e")) {
    EXPECT_EQ(result.mesh.points[v].x, 2);
    found.push_back(1 - result.mesh.points[v].y);
  }
  for (const double h : heights)
    EXPECT_TRUE(std::ranges::any_of(found, [&](double f) { return std::abs(f - h) < 1e-12; })) << h;
}

TEST(Layers, EndsLieOnCurvedWalls) {
  const MeshProblem problem =
      ModelMaker()
          .loop({make_segment({-1, 0}, {1, 0}), make_arc({0, 0}, 1, 0, std::numbers::pi)}, "",
                {"plate", "dome"})
          .problem(0.08, {layer_on({"plate"}, 1e-3, 12)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  for (const int v : nodes_named(result.mesh, "dome")) EXPECT_NEAR(norm(result.mesh.points[v]), 1, 1e-12);
}

TEST(Layers, EndsStandFreeOnAStraightLine) {
  const MeshProblem problem =
      ModelMaker()
          .polygon({{-1, 0}, {0, 0}, {2, 0}, {2, 1}, {-1, 1}}, {"symmetry", "plate", "out", "top", "in"})
          .problem(0.08, {layer_on({"plate"}, 1e-3, 14)});
  expect_layers(problem, mesh(problem, "DBCO"));
}

TEST(Layers, NarrowChannelsLowerThem) {
  const double width = 0.07;
  const MeshProblem problem =
      ModelMaker()
          .polygon({{0, 0},
                    {1, 0},
                    {1, 0.05},
                    {2, 0.05},
                    {2, 0},
                    {3, 0},
                    {3, 1},
                    {2, 1},
                    {2, 0.05 + width},
                    {1, 0.05 + width},
                    {1, 1},
                    {0, 1}},
                   {"a", "a", "a", "a", "a", "out", "top", "a", "a", "a", "top", "in"})
          .problem(0.05, {layer_on({"a"}, 1e-3, 17)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  const double least = result.log.summaries.get<double>("layers", "least_scale");
  EXPECT_LT(least * layer_heights(problem.layers[0]).back(), width / 2);
  EXPECT_GT(least, 0.01);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_TRUE(holds(result.warnings[0].text, "layers are lower", "on 'a'"));
}

std::vector<Vec2> star(int rays, double inner, double outer) {
  std::vector<Vec2> corners;
  for (int i = 0; i < 2 * rays; ++i) {
    const double a = std::numbers::pi * i / rays, r = i % 2 == 0 ? outer : inner;
    corners.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return corners;
}

TEST(Layers, SharpCornersOfStars) {
  for (const bool is_hole : {true, false}) {
    SCOPED_TRACE(is_hole ? "around" : "inside");
    ModelMaker model;
    if (is_hole) model.rectangle({-3, -3}, {3, 3}, {"far"});
    model.polygon(star(6, 0.1, 1), {"star"});
    const MeshProblem problem = model.problem(0.06, {layer_on({"star"}, 1e-3, 10)});
    const MeshResult result = mesh(problem, "DBCO");
    expect_layers(problem, result);
    EXPECT_EQ(count_of(result, "fans"), is_hole ? 6 * 2 : 6);
  }
}

TEST(Layers, StarsByChance) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    std::vector<Vec2> corners;
    const int n = 5 + static_cast<int>(8 * part(random));
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, r = 0.15 + part(random);
      corners.push_back({r * std::cos(a), r * std::sin(a)});
    }
    ModelMaker model;
    if (round % 2 == 0) model.rectangle({-3, -3}, {3, 3}, {"far"});
    model.polygon(corners, {"star", round % 3 == 0 ? "other" : "star"});
    const MeshProblem problem = model.problem(0.07, {layer_on({"star"}, 1e-4 * std::pow(50, part(random)),
                                                              5 + static_cast<int>(15 * part(random)))});
    expect_layers(problem, mesh(problem, "DB"));
  }
}

TEST(Layers, GivenLines) {
  Mesh lines;
  const int n = 60;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    lines.points.push_back({std::cos(a), std::sin(a), 0});
    lines.lines.push_back({i, (i + 1) % n});
    lines.line_curve.push_back(i < n / 2 ? 0 : 1);
  }
  lines.curves = {{1, {"upper"}}, {2, {"lower"}}};
  MeshProblem problem = problem_of(LineModel{lines});
  problem.size.from_boundary = true;
  problem.layers = {layer_on({"upper", "lower"}, 1e-3, 12)};
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  for (int i = 0; i < n; ++i) EXPECT_EQ(result.mesh.points[i], lines.points[i]);
}

TEST(Layers, Airfoils) {
  for (const bool is_sharp : {true, false}) {
    SCOPED_TRACE(is_sharp);
    const MeshProblem problem = naca0012(is_sharp, 1e-5);
    const MeshResult result = mesh(problem, "DBCO");
    expect_layers(problem, result);
    EXPECT_EQ(count_of(result, "fans"), 4);  // of 45 degrees: a corner of 180, or two of 90
    EXPECT_GT(result.metrics.values.at("aspect_max"), 1000);
    for (const double h : first_heights(result.mesh, "airfoil")) EXPECT_LT(h, 1.2e-5);
  }
}

TEST(Layers, QuadsTenThousandTimesAsLongAsHigh) {
  const MeshProblem problem = naca0012(true, 1e-6);
  const MeshResult result = mesh(problem, "DB");
  expect_layers(problem, result);
  EXPECT_GT(result.metrics.values.at("aspect_max"), 10000);
}

TEST(Layers, FansOfThickLayersHaveShorterEdges) {
  const auto fans = [](int number) {
    const MeshProblem problem = ModelMaker()
                                    .rectangle({-2, -2}, {2, 2}, {"far"})
                                    .rectangle({-0.5, -0.5}, {0.5, 0.5}, {"body"})
                                    .problem(0.04, {layer_on({"body"}, 1e-3, number, 1.25)});
    const MeshResult result = mesh(problem, "DB");
    expect_layers(problem, result);
    return count_of(result, "fans");
  };
  EXPECT_EQ(fans(10), 4);
  EXPECT_EQ(fans(20), 8);
}

/// Without sources, quads beside the fan would have 2000 times the area of its first ones.
TEST(Layers, QuadsBesideFansAreNotMuchLarger) {
  for (const auto& [first, number] : {std::pair(1e-3, 5), {1e-4, 25}, {1e-5, 28}}) {
    SCOPED_TRACE(first);
    const MeshProblem problem = ModelMaker()
                                    .rectangle({-1, -1}, {2, 1}, {"far"})
                                    .polygon({{0, -0.05}, {1, 0}, {0, 0.05}}, {"wedge"})
                                    .problem(0.05, {layer_on({"wedge"}, first, number)});
    const MeshResult result = mesh(problem, "DBCO");
    expect_layers(problem, result);
    double least = 1;
    for_each_edge(sorted_half_edges(result.mesh), [&](std::span<const HalfEdge> sides) {
      const auto area = [&](const HalfEdge& side) {
        const auto& [a, b, c, d] = result.mesh.quads[side.element];
        const auto& p = result.mesh.points;
        return norm(cross(p[c] - p[a], p[d] - p[b])) / 2;
      };
      if (sides.size() != 2) return;
      const double ratio = area(sides[0]) / area(sides[1]);
      least = std::min({least, ratio, 1 / ratio});
    });
    EXPECT_GT(least, 0.01);
    EXPECT_GT(result.metrics.values.at("scaled_jacobian_min"), 0.3);
  }
}

TEST(Layers, WarningsOfThinLastLayersNameTheCurve) {
  const MeshProblem problem = ModelMaker()
                                  .rectangle({0, 0}, {2, 1}, {"south", "east", "north", "west"})
                                  .problem(0.1, {layer_on({"north"}, 1e-3, 5)});
  const MeshResult result = mesh(problem, "DB");
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_TRUE(holds(result.warnings[0].text, "times as long as it is high, on 'north'"));
}

TEST(Layers, TheSameBytesForAnyNumberOfThreads) {
  const MeshProblem problem = naca0012(false, 1e-5);
  const MeshResult one = mesh(problem, "DBCO", {.threads = 1}),
                   several = mesh(problem, "DBCO", {.threads = 3});
  EXPECT_EQ(one.mesh.points, several.mesh.points);
  EXPECT_EQ(one.mesh.quads, several.mesh.quads);
}

TEST(Layers, TurnedDomainsHaveThem) {
  MeshProblem problem = naca0012(false, 1e-5);
  problem.seed = 3;
  expect_layers(problem, mesh(problem, "DB"));
}

TEST(Layers, BadInput) {
  const ModelMaker plate = ModelMaker().rectangle({0, 0}, {2, 1}, {"south", "east", "north", "west"});
  const auto refused = [&](const LayerSpec& spec, std::initializer_list<const char*> parts) {
    expect_refused(plate.problem(0.1, {spec}), "DB", parts);
  };
  const LayerSpec good = layer_on({"south"}, 1e-3, 5);
  LayerSpec bad = good;
  bad.on = {"soth"};
  refused(bad, {"layer", "'soth'", "'south'"});
  bad = good, bad.first = 0;
  refused(bad, {"'first' is 0", "above 0"});
  bad = good, bad.growth = 0.5;
  refused(bad, {"'growth' is 0.5", "at least 1"});
  bad = good, bad.number = 0;
  refused(bad, {"none of 'number' and 'thickness'"});
  bad = good, bad.thickness = 0.1;
  refused(bad, {"both of 'number' and 'thickness'"});
  bad = good, bad.thickness = -1, bad.number = 0;
  refused(bad, {"'thickness' is -1"});
  bad = good, bad.fan = 130;
  refused(bad, {"'fan' is 130"});
  bad = good, bad.first = 0.3;
  refused(bad, {"1 wide", "thinner"});
  MeshProblem twice = plate.problem(0.1, {good, good});
  expect_refused(twice, "DB", {"'south' has a layer already"});
  bad = good, bad.into = {"flud"};
  refused(bad, {"no region is called 'flud'"});
}

TEST(Layers, CracksAndLinesInOneRegionHaveNone) {
  const ModelMaker model = ModelMaker()
                               .rectangle({0, 0}, {1, 1}, {"s", "e", "n", "w"})
                               .curve(make_segment({0.3, 0.5}, {0.7, 0.5}), "slit", true)
                               .curve(make_segment({0.3, 0.3}, {0.7, 0.3}), "rib")
                               .curve(make_segment({0.5, 1}, {0.5, 0.8}), "wall");
  const auto refuse = [&](const std::string& on, std::initializer_list<const char*> parts) {
    expect_refused(model.problem(0.1, {layer_on({on}, 1e-3, 5)}), "DB", parts);
  };
  refuse("slit", {"'slit'", "crack"});
  refuse("rib", {"'rib' stands inside of one region"});
  refuse("n", {"another curve meets the layer", "(0.5, 1)", "may begin beyond the layers"});
}

}  // namespace
}  // namespace delquad
