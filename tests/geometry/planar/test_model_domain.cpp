// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

TEST(ModelDomain, AnnulusIsOnePatchWithAHole) {
  for (bool reversed : {false, true}) {
    ModelMaker builder;
    const auto circle = [&](double r) {
      return reversed ? make_arc({0, 0}, r, 2 * std::numbers::pi, 0) : make_circle({0, 0}, r);
    };
    const PlanarDomain domain =
        make_domain(builder.loop({circle(1)}).loop({circle(2)}, "ring"), constant(0.1));
    ASSERT_EQ(domain.patches.size(), 1u);
    EXPECT_EQ(domain.boundary.regions.at(0).names, std::vector<std::string>{"ring"});
    double area = 0;
    const PatchBoundary& patch = domain.patches[0];
    for (const auto& [v, w] : patch.edges) area += 0.5 * cross(patch.points[v], patch.points[w]);
    EXPECT_NEAR(area, 3 * std::numbers::pi, 0.02);
    EXPECT_EQ(patch.edges.size() % 2, 0u);
  }
}

TEST(ModelDomain, InclusionsShareNodesAndAreEven) {
  const PlanarDomain domain = make_domain(ModelMaker()
                                              .loop(rectangle_sides(0, 0, 4, 4), "matrix")
                                              .loop({make_circle({2, 2}, 1)}, "fibre")
                                              .loop({make_circle({2, 2}, 0.5)}),
                                          constant(0.33));
  ASSERT_EQ(domain.patches.size(), 2u);
  EXPECT_EQ(domain.boundary.regions[0].names, std::vector<std::string>{"matrix"});
  EXPECT_EQ(domain.boundary.regions[1].names, std::vector<std::string>{"fibre"});
  std::set<int> matrix(domain.patches[0].point_node.begin(), domain.patches[0].point_node.end());
  int shared = 0, on_circle = 0;
  for (int v : domain.patches[1].point_node) shared += static_cast<int>(matrix.count(v));
  for (int c : domain.boundary.line_curve) on_circle += c == 4;
  EXPECT_EQ(shared, on_circle);
  EXPECT_EQ(shared % 2, 0);
  for (const PatchBoundary& patch : domain.patches) EXPECT_EQ(patch.edges.size() % 2, 0u);
}

TEST(ModelDomain, FourLevelsOfNestingAndDisjointComponents) {
  ModelMaker builder;
  for (double r : {1.0, 4.0, 2.0, 3.0}) builder.loop({make_circle({0, 0}, r)});
  builder.loop(rectangle_sides(10, 0, 11, 1), "box");
  const PlanarDomain domain = make_domain(builder, constant(0.3));
  ASSERT_EQ(domain.patches.size(), 3u);
  EXPECT_EQ(domain.boundary.regions[0].names, std::vector<std::string>{"domain_1"});
  EXPECT_EQ(domain.boundary.regions[1].names, std::vector<std::string>{"domain_2"});
  EXPECT_EQ(domain.boundary.regions[2].names, std::vector<std::string>{"box"});
  for (const PatchBoundary& patch : domain.patches) EXPECT_EQ(patch.edges.size() % 2, 0u);
}

TEST(ModelDomain, AirfoilWithASharpTrailingEdge) {
  const std::string half = "0.6*(0.2969*sqrt(t^2) - 0.1260*t^2 - 0.3516*t^4 + 0.2843*t^6 - 0.1036*t^8)";
  const PlanarModel model =
      ModelMaker()
          .loop(rectangle_sides(-5, -5, 6, 5))
          .loop({make_expression_curve("t^2", half, 0, 1), make_expression_curve("t^2", "-" + half, 0, 1)});
  const TestSize size = [](const Vec3& p) {
    return 0.002 + 0.15 * std::min(std::hypot(p.x, p.y), std::hypot(p.x - 1, p.y));
  };
  const PlanarDomain domain = make_domain(model, size);
  ASSERT_EQ(domain.patches.size(), 1u);
  std::vector<int> edges(6, 0);
  for (int c : domain.boundary.line_curve) ++edges[c];
  EXPECT_GT(edges[4], 40);
  EXPECT_NEAR(edges[4], edges[5], 1);
}

TEST(ModelDomain, CrossingAndTouchingCurvesAreNamed) {
  PlanarModel model = ModelMaker().loop(rectangle_sides(0, 0, 4, 4)).loop({make_circle({4, 2}, 1)});
  model.curves[1].name = "wall";
  model.curves[4].name = "hole";
  model.curves[4].where = "test.toml:12";
  const auto mesh = [&](const PlanarModel& m) { return [&m] { make_domain(m, constant(0.2)); }; };
  expect_input_error(mesh(model), {"test.toml: ", "'wall'", "'hole' (test.toml:12)", "(4, ", "size"});
  const PlanarModel twice = ModelMaker().loop(rectangle_sides(0, 0, 4, 4)).loop(rectangle_sides(0, 0, 4, 4));
  expect_input_error(mesh(twice), {"same curves", "curve 1", "too many"});
}

TEST(ModelDomain, TooCoarseForAGapIsSaid) {
  const PlanarModel model = ModelMaker()
                                .loop({make_circle({0, 0}, 1)})
                                .loop({make_arc({0, 0}, 0.98, 0.3, 0.3 + 2 * std::numbers::pi)});
  expect_input_error([&] { make_domain(model, constant(0.7)); }, {"curve 1", "curve 2", "too large"});
  EXPECT_EQ(make_domain(model, constant(0.1)).patches.size(), 1u);
}

TEST(ModelDomain, SharpCornersTinyEdgesAndSlivers) {
  // A needle of 0.1 degrees, and a notch of 1e-6 in a side.
  const PlanarModel model = ModelMaker()
                                .loop({make_polyline({{0, 0},
                                                      {1, 0},
                                                      {1, 0.5},
                                                      {1 - 1e-6, 0.5},
                                                      {1 - 1e-6, 0.5 + 1e-6},
                                                      {1, 0.5 + 1e-6},
                                                      {1, 1},
                                                      {0, 1},
                                                      {0, 0}})})
                                .loop({make_polyline({{3, 0}, {4, 0}, {4, 0.0017}, {3, 0}})});
  const PlanarDomain domain = make_domain(model, constant(0.1));
  ASSERT_EQ(domain.patches.size(), 2u);
  for (const PatchBoundary& patch : domain.patches) EXPECT_EQ(patch.edges.size() % 2, 0u);
}

TEST(ModelDomain, TheSameBytesTwice) {
  const PlanarModel model = ModelMaker().loop({make_circle({0, 0}, 2)}).loop({make_circle({0.3, 0}, 1)});
  const TestSize size = [](const Vec3& p) { return 0.01 + 0.1 * p.x * p.x; };
  const PlanarDomain a = make_domain(model, size), b = make_domain(model, size);
  EXPECT_EQ(a.boundary.points, b.boundary.points);
  EXPECT_EQ(a.patches.at(0).points, b.patches.at(0).points);
}

}  // namespace
}  // namespace delquad
