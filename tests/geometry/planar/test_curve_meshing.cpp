// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

Mesh mesh_curves(const PlanarModel& model, const TestSize& size, const CurveMeshOptions& options = {}) {
  return make_domain(model, size, options).boundary;
}

std::vector<int> edges_per_curve(const Mesh& mesh) {
  std::vector<int> count(mesh.curves.size(), 0);
  for (int c : mesh.line_curve) ++count[c];
  return count;
}

TEST(CurveMeshing, UnitSquareHasItsNodesAtTwentieths) {
  const Mesh mesh = mesh_curves(ModelMaker().loop(rectangle_sides(0, 0, 1, 1)), constant(0.05));
  ASSERT_EQ(mesh.points.size(), 80u);
  ASSERT_EQ(mesh.lines.size(), 80u);
  EXPECT_EQ(edges_per_curve(mesh), std::vector<int>(4, 20));
  for (const Vec3& p : mesh.points)
    for (double x : {p.x, p.y}) EXPECT_NEAR(x, std::round(20 * x) / 20, 1e-15);
}

TEST(CurveMeshing, RotatedSquareKeepsItsCounts) {
  for (double degrees : {20.0, 37.0}) {
    const double a = degrees * std::numbers::pi / 180;
    const auto turned = [&](double x, double y) {
      return Vec2{x * std::cos(a) - y * std::sin(a), x * std::sin(a) + y * std::cos(a)};
    };
    const PlanarModel model = ModelMaker().loop(
        {make_polyline({turned(0, 0), turned(1, 0), turned(1, 1), turned(0, 1), turned(0, 0)})});
    const Mesh mesh = mesh_curves(model, constant(0.05));
    ASSERT_EQ(mesh.lines.size(), 80u);
    for (const auto& [v, w] : mesh.lines) EXPECT_NEAR(norm(mesh.points[v] - mesh.points[w]), 0.05, 1e-15);
  }
}

TEST(CurveMeshing, CurvesAreNamedAndTagged) {
  PlanarModel model = ModelMaker().loop(rectangle_sides(0, 0, 1, 1));
  model.curves[2].name = "lid";
  const Mesh mesh = mesh_curves(model, constant(0.3));
  ASSERT_EQ(mesh.curves.size(), 4u);
  EXPECT_EQ(mesh.curves[2].tag, 3);
  EXPECT_EQ(mesh.curves[2].names, std::vector<std::string>{"lid"});
  EXPECT_TRUE(mesh.curves[0].names.empty());
}

TEST(CurveMeshing, CoarseSizesKeepEveryPieceAndNoLoopFolds) {
  const TestSize coarse = constant(1000);
  EXPECT_EQ(mesh_curves(ModelMaker().loop({make_circle({0, 0}, 1)}), coarse).lines.size(), 4u);
  // A half disc: neither the arc nor its chord may be a single edge.
  const Mesh half = mesh_curves(
      ModelMaker().loop({make_arc({0, 0}, 1, 0, std::numbers::pi), make_segment({-1, 0}, {1, 0})}), coarse);
  EXPECT_EQ(edges_per_curve(half), (std::vector<int>{2, 2}));
  const auto triangle = ModelMaker().loop({make_polyline({{0, 0}, {1, 0}, {0, 1}, {0, 0}})});
  EXPECT_EQ(mesh_curves(triangle, coarse).lines.size(), 4u);
}

TEST(CurveMeshing, ParityIsMendedWhereItCostsLeast) {
  // 10.4 and 10.3 round to 10, 3.1 to 3, 7.45 to 7: the sum is even already. With 2.9 there it is odd, and 10
  // -> 11 for the 10.4 side costs least.
  const auto quadrangle = [](double a, double b, double c, double d) {
    // Sides a and c horizontal-ish; the lengths matter, not the shape.
    const Vec2 p0{0, 0}, p1{a, 0};
    const Vec2 p3{0.2 * d, std::sqrt(0.96) * d};
    const Vec2 e = p3 - p1;
    const double l = norm(e), x = (l * l + b * b - c * c) / (2 * l), y = std::sqrt(b * b - x * x);
    const Vec2 u = (1 / l) * e, p2 = p1 + x * u - y * perp(u);
    return ModelMaker().loop(
        {make_segment(p0, p1), make_segment(p1, p2), make_segment(p2, p3), make_segment(p3, p0)});
  };
  EXPECT_EQ(edges_per_curve(mesh_curves(quadrangle(10.4, 10.3, 3.1, 7.45), constant(1))),
            (std::vector<int>{10, 10, 3, 7}));
  EXPECT_EQ(edges_per_curve(mesh_curves(quadrangle(10.4, 10.3, 3.1, 6.05), constant(1))),
            (std::vector<int>{11, 10, 3, 6}));
  // The longest side is not always the cheapest: 4.5 is as near to 4 as to 5.
  EXPECT_EQ(edges_per_curve(mesh_curves(quadrangle(7.0, 7.0, 4.49, 7.0), constant(1))),
            (std::vector<int>{7, 7, 5, 7}));
}

TEST(CurveMeshing, TiesGoToTheFirstCurve) {
  const auto triangle = ModelMaker().loop({make_segment({0, 0}, {4, 0}), make_segment({4, 0}, {4, 4}),
                                           make_segment({4, 4}, {0, 4}), make_segment({0, 4}, {0, 2}),
                                           make_segment({0, 2}, {0, 1}), make_segment({0, 1}, {0, 0})});
  // 4 + 4 + 4 + 2 + 1 + 1 is even; at 4/3 each side has 3, the rest 2, 1, 1: odd.
  EXPECT_EQ(edges_per_curve(mesh_curves(triangle, constant(4 / 3.0)))[0], 4);
}

double angle_of(int i, int n) { return 2 * std::numbers::pi * i / n; }

// A star-shaped loop of segments and circles' arcs, with holes and inclusions inside.
PlanarModel random_model(std::mt19937& engine) {
  std::uniform_real_distribution<double> unit(0, 1);
  ModelMaker builder;
  const int components = 1 + static_cast<int>(engine() % 3);
  for (int k = 0; k < components; ++k) {
    const Vec2 centre{10.0 * k, 3 * unit(engine)};
    const int corners = 3 + static_cast<int>(engine() % 6);
    std::vector<Vec2> points;
    for (int i = 0; i < corners; ++i)
      points.push_back(centre + (3.2 + unit(engine)) *
                                    Vec2{std::cos(angle_of(i, corners)), std::sin(angle_of(i, corners))});
    std::vector<ModelMaker::Shape> sides;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 a = points[i], b = points[(i + 1) % points.size()];
      sides.push_back(engine() % 2 ? make_segment(a, b) : make_segment(b, a));
    }
    std::ranges::shuffle(sides, engine);
    builder.loop(sides, k == 0 ? "first" : "");
    const int holes = static_cast<int>(engine() % 4);
    for (int h = 0; h < holes; ++h) {
      const Vec2 middle = centre + 1.0 * Vec2{std::cos(angle_of(h, 3)), std::sin(angle_of(h, 3))};
      const double radius = 0.25 + 0.3 * unit(engine);
      builder.loop({make_circle(middle, radius)}, engine() % 2 ? "filling" : "");
      if (engine() % 2) builder.loop({make_circle(middle, 0.4 * radius)}, engine() % 2 ? "core" : "");
    }
  }
  return builder;
}

TEST(CurveMeshing, EveryPatchOfRandomModelsIsEven) {
  std::mt19937 engine(11);
  std::map<std::string, int> kinds;
  for (int round = 0; round < 300; ++round) {
    const PlanarModel model = random_model(engine);
    const double h = std::uniform_real_distribution<double>(0.05, 0.4)(engine);
    const TestSize size = [h](const Vec3& p) { return h * (1 + 0.3 * std::sin(p.x + 2 * p.y)); };
    const PlanarDomain domain = make_domain(model, size);
    for (const PatchBoundary& patch : domain.patches) {
      EXPECT_EQ(patch.edges.size() % 2, 0u) << round;
      ++kinds[domain.boundary.regions[&patch - domain.patches.data()].names.at(0)];
    }
  }
  for (const char* kind : {"first", "filling", "core", "domain", "domain_2"})
    EXPECT_GT(kinds[kind], 10) << kind;
}

CurveMeshOptions agreeing() {
  CurveMeshOptions options;
  options.agreement.price = 3;
  return options;
}

TEST(CurveMeshing, OppositeSidesAgree) {
  const PlanarModel wedge = ModelMaker().loop({make_segment({0, 0}, {3, 0}), make_segment({3, 0}, {3, 5}),
                                               make_segment({3, 5}, {0, 4}), make_segment({0, 4}, {0, 0})});
  EXPECT_EQ(edges_per_curve(mesh_curves(wedge, constant(0.5))), (std::vector<int>{6, 10, 6, 8}));
  EXPECT_EQ(edges_per_curve(mesh_curves(wedge, constant(0.5), agreeing())), (std::vector<int>{6, 9, 6, 9}));
}

TEST(CurveMeshing, PatchesOfRandomModelsWithNumbersThatAgreeAreEven) {
  std::mt19937 engine(12);
  for (int round = 0; round < 100; ++round) {
    const double h = std::uniform_real_distribution<double>(0.05, 0.4)(engine);
    for (const PatchBoundary& patch : make_domain(random_model(engine), constant(h), agreeing()).patches)
      EXPECT_EQ(patch.edges.size() % 2, 0u) << round;
  }
}

TEST(CurveMeshing, NodesOfNarrowRingsAreEven) {
  const PlanarModel ring = ModelMaker().loop({make_circle({0, 0}, 1)}).loop({make_circle({0, 0}, 0.8)});
  CurveMeshOptions options = agreeing();
  options.agreement.narrow_grids = true;
  const Mesh mesh = mesh_curves(ring, constant(0.15), options);
  const std::vector<int> edges = edges_per_curve(mesh);
  EXPECT_EQ(edges[0], edges[1]);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Vec3 &a = mesh.points[mesh.lines[l][0]], &b = mesh.points[mesh.lines[l][1]];
    const double radius = mesh.line_curve[l] == 0 ? 1 : 0.8;
    EXPECT_NEAR(norm(a), radius, 1e-15);
    EXPECT_NEAR(norm(b - a), 2 * radius * std::sin(std::numbers::pi / edges[0]), 1e-10);
  }
}

TEST(CurveMeshing, EdgesOfACurveAreAllAsLongAsTheSizeSays) {
  const TestSize size = [](const Vec3& p) { return 1e-4 + 0.1 * std::hypot(p.x, p.y); };
  const Mesh mesh = mesh_curves(ModelMaker().loop(rectangle_sides(0, 0, 1, 1)), size);
  std::vector<double> shortest(4, 10), longest(4, 0);
  int hint = -1;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Vec3 a = mesh.points[mesh.lines[l][0]];
    const Vec3 b = mesh.points[mesh.lines[l][1]];
    const double ratio = norm(b - a) / size.at(0.5 * (a + b), hint);
    const auto c = static_cast<std::size_t>(mesh.line_curve[l]);
    shortest[c] = std::min(shortest[c], ratio);
    longest[c] = std::max(longest[c], ratio);
  }
  // The size changes by a tenth along an edge, so its value at the middle is its harmonic mean to 0.1 %.
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_LT(longest[c] / shortest[c], 1.002);
    EXPECT_NEAR(longest[c], 1, 0.1);
  }
}

TEST(CurveMeshing, LimitIsStatedBeforeWorkStarts) {
  const PlanarModel model = ModelMaker().loop(rectangle_sides(0, 0, 1, 1));
  expect_input_error([&] { mesh_curves(model, constant(1e-12)); }, {"test.toml", "4e+12 edges", "1e+08"});
  expect_input_error([&] { mesh_curves(model, constant(0.01), {100}); }, {"400 edges", "100"});
  EXPECT_EQ(mesh_curves(model, constant(0.01), {400}).lines.size(), 400u);
}

TEST(CurveMeshing, BadSizesAreInputErrors) {
  const PlanarModel model = ModelMaker().loop(rectangle_sides(0, 0, 1, 1));
  expect_input_error([&] { mesh_curves(model, constant(-1)); }, {"test.toml", "curve 1", "size is -1"});
  expect_input_error([&] { mesh_curves(model, [](const Vec3& p) { return std::sqrt(0.99 - p.y); }); },
                     {"size is", "nan", "curve 2"});
}

}  // namespace
}  // namespace delquad
