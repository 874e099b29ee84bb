// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/adapt.h"
#include "mesher/adapt/adapt.h"
#include "tests/mesher/adapt/ugly_quads.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

double shock(double x, double y) { return std::tanh(20 * (x + 0.5 * y - 0.7)); }

/// A disc in a square with a round hole, by two regions with names; the hole has one, too.
Mesh ring_in_square() {
  MeshProblem problem;
  PlanarModel model;
  model.source = "ring";
  model.curves = {{make_polyline({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}, {-2, -2}}), "frame", "", false},
                  {make_circle({0, 0}, 1), "seam", "", false},
                  {make_circle({0.2, 0}, 0.4), "hole", "", false}};
  model.loops = {{{0}, "outside", "", false}, {{1}, "ring", "", false}, {{2}, "", "", true}};
  model.points = {{{1.5, 1.5}, "probe", ""}};
  problem.model = model;
  problem.size.text = "0.15";
  return mesh(problem, "good").mesh;
}

TEST(ModelOfMesh, CurvesRegionsAndNamesStay) {
  const Mesh given = ring_in_square();
  PlanarModel model = trace_mesh(given);
  for (ModelCurve& curve : model.curves) curve.name = given.curves.at(std::stoi(curve.name)).names.at(0);
  std::map<std::string, int> number;
  for (const ModelCurve& curve : model.curves) ++number[curve.name];
  EXPECT_EQ(number, (std::map<std::string, int>{{"frame", 4}, {"seam", 1}, {"hole", 1}}));
  ASSERT_EQ(model.loops.size(), 3u);
  // Smooth through the nodes: as good as round.
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k <= 100; ++k) {
      const Vec2 p = curve.shape->point(k / 100.0);
      if (curve.name == "seam") {
        EXPECT_NEAR(norm(p), 1, 1e-6);
      }
      if (curve.name == "hole") {
        EXPECT_NEAR(norm(p - Vec2{0.2, 0}), 0.4, 2e-6);
      }
      if (curve.name == "frame") {
        EXPECT_EQ(std::max(std::abs(p.x), std::abs(p.y)), 2);
      }
    }
}

TEST(Adapt, TheNextMeshHasTheSameDomain) {
  Mesh given = ring_in_square();
  for (auto& v : given.quads) std::swap(v[1], v[3]);  // whichever way they run
  const auto values = values_of(given, [](double x, double y) { return std::tanh(5 * (x + y)) + x * y; });
  const Adapted made = adapt(given, {{"u", values}}, {.quads = 1500});
  const Mesh& mesh = made.result.mesh;
  EXPECT_TRUE(made.result.soundness.sound());
  EXPECT_NEAR(static_cast<double>(mesh.quads.size()), 1500, 150);
  const auto names = [](const Mesh& m) {
    std::vector<std::pair<int, Strings>> all;
    for (const auto* entities : {&m.curves, &m.regions})
      for (const Entity& e : *entities) all.emplace_back(e.tag, e.names);
    for (const NamedPoint& p : m.named_points) all.emplace_back(p.entity.tag, p.entity.names);
    return all;
  };
  EXPECT_EQ(names(mesh), names(given));
  const auto area = [](const Mesh& m, const std::string& region) {
    double sum = 0;
    for (std::size_t q = 0; q < m.quads.size(); ++q) {
      const auto& v = m.quads[q];
      if (m.regions[m.quad_region[q]].names[0] == region)
        sum += cross(m.points[v[2]] - m.points[v[0]], m.points[v[3]] - m.points[v[1]]).z / 2;
    }
    return sum;
  };
  const double round = std::numbers::pi;
  EXPECT_NEAR(area(mesh, "outside"), 16 - round, 0.02);
  EXPECT_NEAR(area(mesh, "ring"), round * (1 - 0.16), 0.02);
}

// The L2 error by the mean of samples inside of quads.
double error_of(const Mesh& mesh) {
  double sum = 0;
  constexpr int kSamples = 4;
  for (const auto& v : mesh.quads)
    for (int i = 0; i < kSamples; ++i)
      for (int k = 0; k < kSamples; ++k) {
        const double s = (i + 0.5) / kSamples, t = (k + 0.5) / kSamples;
        const double w[] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
        Vec3 x;
        double value = 0;
        for (int c = 0; c < 4; ++c) {
          const Vec3& p = mesh.points[v[c]];
          x = x + w[c] * p;
          value += w[c] * shock(p.x, p.y);
        }
        const double area =
            cross(mesh.points[v[2]] - mesh.points[v[0]], mesh.points[v[3]] - mesh.points[v[1]]).z / 2;
        sum += area / (kSamples * kSamples) * std::pow(shock(x.x, x.y) - value, 2);
      }
  return std::sqrt(sum);
}

// Where nothing happens sides are as long as they may be: a rim is round again in the next mesh.
TEST(Adapt, ARimStaysRound) {
  MeshProblem problem;
  PlanarModel disc{"disc", {{make_circle({0, 0}, 1), "rim", ""}}, {{{0}, "", ""}}};
  problem.model = disc;
  problem.size.text = "0.2";
  Mesh mesh = delquad::mesh(problem, "fast").mesh;
  for (int round = 0; round < 3; ++round) {
    const auto values = values_of(mesh, [](double x, double) { return std::tanh(30 * (x - 0.6)); });
    mesh = adapt(mesh, {{"u", values}}, {.quads = 120, .quality = "fast"}).result.mesh;
    for (const auto& line : mesh.lines)
      for (const int v : line) EXPECT_NEAR(norm(mesh.points[v]), 1, 1e-3);
  }
}

TEST(Adapt, CracksAreNotTraced) {
  MeshProblem problem;
  PlanarModel model = polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  model.curves.push_back({make_segment({0.2, 0.5}, {0.7, 0.5}), "crack", "", true});
  problem.model = model;
  problem.size.text = "0.1";
  const Mesh mesh = delquad::mesh(problem, "fast").mesh;
  expect_input_error([&] { adapt(mesh, {{"u", values_of(mesh, shock)}}, {.quads = 200}); }, {"crack"});
}

TEST(Adapt, ErrorsFallAndAreExpected) {
  Mesh mesh = quad_grid(24, 24);
  const double uniform = error_of(mesh);
  Adapted made;
  for (int k = 0; k < 2; ++k) {
    made = adapt(mesh, {{"u", values_of(mesh, shock)}}, {.quads = 600, .quality = "fast"});
    mesh = made.result.mesh;
  }
  EXPECT_LT(error_of(mesh), uniform / 12);
  EXPECT_NEAR(made.errors[0].after / error_of(mesh), 1, 0.25);
  Mesh squares = quad_grid(24, 24);
  for (int k = 0; k < 2; ++k)
    squares = adapt(squares, {{"u", values_of(squares, shock)}},
                    {.quads = 600, .isotropic = true, .quality = "fast"})
                  .result.mesh;
  EXPECT_LT(error_of(squares), uniform / 2);
  EXPECT_GT(error_of(squares), 2 * error_of(mesh));
}

TEST(Adapt, AnErrorThatIsAskedFor) {
  const Mesh mesh = ugly_quads(24);
  const Adapted made = adapt(mesh, {{"u", values_of(mesh, shock)}}, {.error = 1e-3, .quality = "fast"});
  EXPECT_NEAR(made.errors[0].after, 1e-3, 2e-4);
  EXPECT_NEAR(error_of(made.result.mesh), 1e-3, 3e-4);
}

std::vector<Tensor2> metric_for(const Mesh& mesh, const std::vector<std::vector<double>>& fields,
                                const AdaptSpec& spec) {
  std::vector<Recovery> solutions;
  for (const auto& values : fields) solutions.push_back(recover(mesh, values));
  return adapted_metric(mesh, solutions, spec);
}

// |H| is diag(2, 32) everywhere: lengths are as 4 to 1, and their product is the area over the number.
TEST(AdaptedMetric, OfAQuadratic) {
  const Mesh mesh = quad_grid(6, 6);
  const auto values = values_of(mesh, [](double x, double y) { return x * x - 16 * y * y; });
  for (const double p : {1.0, 2.0, std::numeric_limits<double>::infinity()})
    for (const Tensor2& m : metric_for(mesh, {values}, {.quads = 400, .norm = p})) {
      EXPECT_NEAR(m.xx, 100, 1);
      EXPECT_NEAR(m.yy, 1600, 16);
      EXPECT_NEAR(m.xy, 0, 1e-6);
    }
  for (const Tensor2& m : metric_for(mesh, {values}, {.quads = 400, .isotropic = true})) {
    EXPECT_NEAR(m.xx, 400, 4);
    EXPECT_NEAR(m.yy, 400, 4);
  }
  for (const Tensor2& m : metric_for(mesh, {values}, {.quads = 400, .limits = {.aspect = 2}}))
    EXPECT_NEAR(m.yy / m.xx, 4, 1e-9);
  const auto turned = values_of(mesh, [](double x, double y) { return 1e6 * (16 * x * x + y * y); });
  for (const Tensor2& m : metric_for(mesh, {values, turned}, {.quads = 400}))
    EXPECT_NEAR(m.xx, m.yy, 1e-6 * m.xx);
}

TEST(AdaptedMetric, ConstantPartsAreAsLargeAsAllowed) {
  const Mesh mesh = quad_grid(32, 32);
  const auto values =
      values_of(mesh, [](double x, double) { return x < 0.75 ? 2 : 2 + 100 * std::pow(x - 0.75, 3); });
  const auto metric = metric_for(mesh, {values}, {.quads = 1000, .limits = {.max = 0.25}});
  for (std::size_t i = 0; i < metric.size(); ++i)
    if (mesh.points[i].x < 0.5) {
      EXPECT_EQ(axes_of(metric[i]).h1, 0.25);
    }
}

// What is weighted with 0 counts as constant.
TEST(AdaptedMetric, WeightsCount) {
  const Mesh mesh = quad_grid(16, 16);
  const auto values = values_of(mesh, [](double x, double y) { return x * x + y * y; });
  const auto weight = values_of(mesh, [](double x, double) { return x < 0.5 ? 0 : 1; });
  const auto metric = metric_for(mesh, {values}, {.quads = 800, .limits = {.max = 0.5}, .weight = weight});
  for (std::size_t i = 0; i < metric.size(); ++i)
    EXPECT_NEAR(axes_of(metric[i]).h1, mesh.points[i].x < 0.5 ? 0.5 : 1 / 38.8, 0.003);
}

TEST(Adapt, WrongInput) {
  const Mesh mesh = quad_grid(4, 4);
  const std::vector<double> bent = values_of(mesh, shock);
  const auto refused = [&](const std::vector<NodalField>& fields, const AdaptSpec& spec,
                           std::initializer_list<const char*> parts) {
    expect_input_error([&] { adapt(mesh, fields, spec); }, parts);
  };
  refused({}, {.quads = 100}, {"there is no field"});
  refused({{"u", std::vector<double>(25, 7)}}, {.quads = 100}, {"u: constant or linear"});
  refused({{"u", std::vector<double>(16, 7)}}, {.quads = 100}, {"the field u has 16 values", "25 points"});
  refused({{"u", bent}}, {}, {"0 quads and an error of 0", "expected one of both"});
  refused({{"u", bent}}, {.quads = 100, .norm = 0.5}, {"the norm 0.5: expected 1 to infinity"});
  refused({{"u", bent}}, {.quads = 0.5}, {"0.5 quads: the 4 sides of the outline need 1 at least"});
  refused({{"u", bent}}, {.quads = 100, .weight = std::vector<double>(25, -1)},
          {"weight is -1 at (0, 0, 0)"});
  for (const MetricLimits& limits : {MetricLimits{0.5, 0.1}, {-1}, {0, 0, 0.5}})
    refused({{"u", bent}}, {.quads = 100, .limits = limits, .isotropic = true}, {"0 stands for no limit"});
  refused({{"u", bent}}, {.quads = 100, .gradation = 0.5}, {"gradation 0.5"});
  refused({{"u", bent}}, {.error = 1e-9, .limits = {.min = 0.1}}, {"1e-09 is not reached"});
  Mesh curved = mesh;
  curved.points[3].z = 1;
  expect_input_error([&] { adapt(curved, {{"u", bent}}, {.quads = 100}); }, {"is not planar"});
}

}  // namespace
}  // namespace delquad
