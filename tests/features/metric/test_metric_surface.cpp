// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

double value_of(const MeshResult& result, const char* key) { return result.metrics.values.at(key); }

MeshProblem by_chord(Model model, double chord, double max) {
  MeshProblem problem = problem_of(std::move(model));
  problem.metric.chord = chord;
  problem.metric.limits.max = max;
  return problem;
}

/// A can of radius 1 and height 10.
TriangleModel tall_can() {
  TriangleModel model{can(96, 24)};
  for (Vec3& p : model.mesh.points) p.z *= 10;
  return model;
}

// Sides around are as long as the chord allows, those along the axis as long as anything may be.
TEST(MetricSurface, QuadsOfACylinderAreLong) {
  const double chord = 0.01, around = std::sqrt(8 * chord), along = 2;
  const MeshResult result = mesh(by_chord(tall_can(), chord, along), "good");
  EXPECT_TRUE(result.soundness.sound());
  int on_wall = 0;
  for (std::size_t q = 0; q < result.mesh.quads.size(); ++q) {
    double low = 10, high = 0;
    for (const int v : result.mesh.quads[q])
      low = std::min(low, result.mesh.points[v].z), high = std::max(high, result.mesh.points[v].z);
    if (!(high - low > 1e-9)) continue;
    ++on_wall;
    EXPECT_NEAR(high - low, along, 0.2 * along);
  }
  EXPECT_NEAR(on_wall, 2 * std::numbers::pi / around * 10 / along, 12);
  EXPECT_GT(value_of(result, "metric_eta_mean"), 0.85);
  const double extent = std::sqrt(4 + 4 + 100);
  EXPECT_LT(result.surface->mesh_to_surface.max * extent, 1.5 * chord);
}

TEST(MetricSurface, CurvedElementsAreProven) {
  MeshProblem problem = by_chord(tall_can(), 0.03, 3);
  problem.order = 2;
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_EQ(result.mesh.order, 2);
  EXPECT_EQ(proven_jacobians(result.mesh).unproven, 0);
}

/// [0, 1]^2 in the plane that e and f span.
TriangleModel tilted_square(const Vec3& e, const Vec3& f) {
  constexpr int kCells = 8;
  TriangleModel model;
  Mesh& made = model.mesh;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) made.points.push_back((1.0 * i / kCells) * e + (1.0 * j / kCells) * f);
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const int a = j * (kCells + 1) + i, b = a + 1, c = b + kCells + 1, d = c - 1;
      made.triangles.push_back({a, b, c});
      made.triangles.push_back({a, c, d});
    }
  made.triangle_region.assign(made.triangles.size(), 0);
  made.regions = {{1, {}}};
  return model;
}

// A plane in space with a constant metric is what it is in the plane.
TEST(MetricSurface, APlaneInSpaceIsThePlane) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Vec3 e{c, 0, s}, f{-s * s, c, s * c};
  const double along = 1 / (0.2 * 0.2), across = 1 / (0.02 * 0.02);
  MeshProblem in_space = problem_of(tilted_square(e, f));
  in_space.metric.in_space = [&](std::span<const Vec3> points, std::span<Tensor3> metric) {
    for (std::size_t i = 0; i < points.size(); ++i)
      metric[i] = {along * e.x * e.x + across * f.x * f.x, along * e.x * e.y + across * f.x * f.y,
                   along * e.x * e.z + across * f.x * f.z, along * e.y * e.y + across * f.y * f.y,
                   along * e.y * e.z + across * f.y * f.z, along * e.z * e.z + across * f.z * f.z};
  };
  MeshProblem in_plane = problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}));
  in_plane.metric.sizes = {"0.2", "0.02"};
  const MeshResult there = mesh(in_space, "DB"), here = mesh(in_plane, "DB");
  EXPECT_EQ(there.mesh.quads.size(), here.mesh.quads.size());
  for (const char* key : {"metric_eta_mean", "metric_eta_worst", "metric_edge_min", "metric_edge_max"})
    EXPECT_NEAR(value_of(there, key), value_of(here, key), 1e-3) << key;
  EXPECT_NEAR(value_of(there, "metric_tau"), value_of(here, "metric_tau"), 0.1);
  EXPECT_NEAR(there.prepared->size.expected_quads, 250, 1);
  // The same at the nodes of a mesh.
  const Mesh& nodes = std::get<TriangleModel>(in_space.model).mesh;
  std::vector<Tensor3> metric(nodes.points.size());
  in_space.metric.in_space(nodes.points, metric);
  // Only its tangent part counts, and it must have a logarithm.
  const Vec3 n = cross(e, f);
  for (Tensor3& m : metric)
    m = {m.xx + n.x * n.x, m.xy + n.x * n.y, m.xz + n.x * n.z,
         m.yy + n.y * n.y, m.yz + n.y * n.z, m.zz + n.z * n.z};
  in_space.metric.in_space = make_nodal_space_metric(nodes, metric);
  EXPECT_EQ(mesh(in_space, "DB").mesh.quads.size(), there.mesh.quads.size());
}

TEST(MetricSurface, EmbeddedLinesStay) {
  MeshProblem problem = problem_of(tilted_square({1, 0, 0}, {0, 1, 0}));
  problem.metric.in_space = [](std::span<const Vec3> points, std::span<Tensor3> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) metric[i] = {100, 0, 0, 400, 0, 1};
  };
  EmbeddedLine& line = problem.surface.embed.emplace_back();
  line.points = {{0.2, 0.3, 0}, {0.8, 0.6, 0}};
  line.name = "inside";
  const MeshResult result = mesh(problem, "DB");
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_NEAR(length_named(result.mesh, "inside"), std::hypot(0.6, 0.3), 1e-12);
}

// A metric without directions is a size: on a sphere all curvatures are one.
TEST(MetricSurface, ASphereHasNoDirections) {
  const MeshResult result = mesh(by_chord(ExampleModel{"sphere"}, 0.05, 20), "good");
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_LT(value_of(result, "aspect_mean"), 1.3);
  const double side = std::sqrt(8 * 0.05 * 10), area = 400 * std::numbers::pi;
  EXPECT_NEAR(static_cast<double>(result.mesh.quads.size()), area / (side * side),
              0.1 * area / (side * side));
}

// Closed, with curvatures of both signs, and none along its top and bottom circles.
TEST(MetricSurface, ATorusIsClosed) {
  const MeshResult result = mesh(by_chord(ExampleModel{"torus"}, 0.05, 10), "good");
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_EQ(result.surface->mesh.euler_characteristic, 0);
  EXPECT_GT(value_of(result, "metric_eta_mean"), 0.85);
  EXPECT_GT(value_of(result, "metric_tau"), 88);
}

// For the same distance from the surface sizes without directions take twice as many quads.
TEST(MetricSurface, FilletsTakeFewerQuads) {
  const double extent = 119.8;
  const MeshResult by_metric = mesh(by_chord(ExampleModel{"bracket"}, 0.08, 6), "good");
  MeshProblem by_size = problem_of(ExampleModel{"bracket"});
  by_size.size = {.text = "6", .curvature = 20};
  const MeshResult even = mesh(by_size, "good");
  EXPECT_TRUE(by_metric.soundness.sound());
  EXPECT_LT(by_metric.surface->mesh_to_surface.mean, 1.1 * even.surface->mesh_to_surface.mean);
  EXPECT_LT(by_metric.surface->mesh_to_surface.max * extent, 4 * 0.06);
  EXPECT_LT(2 * by_metric.mesh.quads.size(), even.mesh.quads.size());
}

// Planes at slivers turn from point to point: what is asked for there must not become ever smaller on the
// way.
TEST(MetricSurface, SliversMakeNothingFiner) {
  for (const char* name : {"cross_drilled", "loft"}) {
    const MeshResult result = mesh(by_chord(ExampleModel{name}, 0.1, 8), "good");
    EXPECT_TRUE(result.soundness.sound()) << name;
    EXPECT_LT(result.mesh.quads.size(), 1000u) << name;
  }
}

TEST(MetricSurface, ThereAreAsManyQuadsAsAreAskedFor) {
  MeshProblem problem = by_chord(tall_can(), 0.01, 2);
  problem.metric.complexity = 600;
  EXPECT_NEAR(prepare(problem)->size.expected_quads, 600, 20);
  problem.quads = 900;
  EXPECT_NEAR(static_cast<double>(mesh(problem, "good").mesh.quads.size()), 900, 40);
}

TEST(MetricSurface, RefusesWhatDoesNotGoWithIt) {
  const auto refuses = [](const std::function<void(MeshProblem&)>& change,
                          std::initializer_list<const char*> parts) {
    MeshProblem problem = by_chord(tall_can(), 0.01, 2);
    change(problem);
    expect_refused(problem, "DB", parts);
  };
  refuses([](MeshProblem& p) { p.size.text = "1"; }, {"a size does not go with a metric"});
  refuses([](MeshProblem& p) { p.size.curvature = 12; }, {"a size does not go with a metric"});
  refuses([](MeshProblem& p) { p.symmetry.automatic = true; }, {"symmetry", "not go with a metric"});
  refuses(
      [](MeshProblem& p) {
        p.metric = {.sizes = {"1", "2"}};
      },
      {"a metric of a surface: expected 'chord'"});
  refuses(
      [](MeshProblem& p) {
        p.metric = {.tensor = {"1", "0", "0", "-1", "0", "1"}};
      },
      {"the metric is [1, 0, 0, -1, 0, 1]", "positive definite"});
  MeshProblem planar = problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}));
  planar.metric.chord = 0.1;
  expect_refused(planar, "DB", {"for surfaces"});
}

}  // namespace
}  // namespace delquad
