// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

LayerSpec thick_layer(std::vector<std::string> on, double first, double thickness) {
  LayerSpec layer = layer_on(std::move(on), first, 0);
  layer.thickness = thickness;
  return layer;
}

double least_scale(const MeshResult& result) {
  return result.log.summaries.get<double>("layers", "least_scale");
}

/// All layers, each as high as it was asked for, and no bad quads beside them.
MeshResult expect_whole(const MeshProblem& problem) {
  MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  EXPECT_EQ(least_scale(result), 1.0);
  EXPECT_GT(result.metrics.values.at("scaled_jacobian_min"), 0.3);
  return result;
}

void expect_first(const Mesh& mesh, const std::string& on, double first) {
  const std::vector<double> heights = first_heights(mesh, on);
  ASSERT_FALSE(heights.empty());
  for (const double h : heights) EXPECT_NEAR(h, first, 1e-9);
}

TEST(LayerEnds, BluntTrailingEdges) {
  for (const double first : {1e-3, 1e-5}) {
    SCOPED_TRACE(first);
    MeshProblem problem = naca0012(false, first);
    std::get<PlanarModel>(problem.model).curves[5].name = "base";
    const MeshResult result = expect_whole(problem);
    // Nodes of the base are as far apart as nodes of the sides that stand at its ends.
    double shortest = 1;
    for (const auto& [a, b] : lines_named(result.mesh, "base"))
      shortest = std::min(shortest, norm(result.mesh.points[b] - result.mesh.points[a]));
    EXPECT_NEAR(shortest / first, first > 5e-4 ? 0.52 : 1, 1e-6);
  }
}

TEST(LayerEnds, BackwardSteps) {
  const ModelMaker model = ModelMaker().polygon({{0, 0.1}, {1, 0.1}, {1, 0}, {3, 0}, {3, 1}, {0, 1}},
                                                {"before", "step", "after", "out", "top", "in"});
  const MeshResult one = expect_whole(model.problem(0.05, {thick_layer({"before"}, 1e-3, 0.15)}));
  expect_first(one.mesh, "before", 1e-3);
  // That behind the step fits it; that before it does not care.
  const MeshProblem problem = model.problem(0.05, {thick_layer({"before", "after"}, 1e-3, 0.15)});
  const MeshResult both = mesh(problem, "DBCO");
  expect_layers(problem, both);
  expect_first(both.mesh, "before", 1e-3);
  EXPECT_LE(least_scale(both) * layer_heights(problem.layers[0]).back(), 0.45 * 0.1);
  ASSERT_FALSE(both.warnings.empty());
  EXPECT_TRUE(holds(both.warnings[0].text, "(1, 0) on 'after'"));
}

TEST(LayerEnds, BumpsLowerThanTheLayers) {
  const MeshProblem problem =
      ModelMaker()
          .polygon({{0, 0}, {1, 0}, {1, 0.004}, {1.1, 0.004}, {1.1, 0}, {2, 0}, {2, 1}, {0, 1}},
                   {"floor", "side", "bump", "side", "floor", "out", "top", "in"})
          .problem(0.05, {thick_layer({"floor", "bump"}, 1e-3, 0.05)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  expect_first(result.mesh, "bump", 1e-3);
  EXPECT_LT(least_scale(result) * layer_heights(problem.layers[0]).back(), 0.004);
}

TEST(LayerEnds, ThinPlates) {
  const ModelMaker plate = ModelMaker()
                               .rectangle({-2, -2}, {3, 2}, {"far"})
                               .rectangle({0, 0}, {1, 0.02}, {"below", "edge", "above", "edge"});
  expect_whole(plate.problem(0.1, {thick_layer({"below"}, 1e-3, 0.02)}));
  expect_whole(plate.problem(0.1, {thick_layer({"below", "above"}, 1e-4, 0.03)}));
}

TEST(LayerEnds, CylinderOnAShortBase) {
  ModelMaker model = ModelMaker().rectangle({-2, -2}, {3, 2}, {"far"});
  const double half = 0.1, from = -std::numbers::pi / 2 + half, to = 1.5 * std::numbers::pi - half;
  const auto at = [](double a) { return Vec2{0.3 * std::cos(a), 0.3 * std::sin(a)}; };
  model.loop({make_arc({0, 0}, 0.3, from, to), make_segment(at(to), at(from))}, "", {"round", "base"});
  model.loops.back().is_hole = true;
  for (const char* on : {"round", "base"}) {
    SCOPED_TRACE(on);
    expect_whole(model.problem(0.1, {thick_layer({on}, 1e-3, 0.15)}));
  }
}

TEST(LayerEnds, TwoOnOneShortWall) {
  const MeshProblem problem =
      ModelMaker()
          .polygon({{-0.05, 0}, {0.05, 0}, {1, 1}, {-1, 1}}, {"wall", "side", "top", "side"})
          .problem(0.08, {thick_layer({"side"}, 1e-3, 0.1)});
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  EXPECT_LT(least_scale(result), 0.5);
}

}  // namespace
}  // namespace delquad
