// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

/// n x m squares halved, whose corners lie at `place`(i, j); rows and columns close where it says so.
Mesh scan(int n, int m, bool closes, const std::function<Vec3(int, int)>& place) {
  Mesh mesh;
  const int columns = closes ? n : n + 1, rows = closes ? m : m + 1;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.points.push_back(place(i, j));
  const auto at = [&](int i, int j) { return (j % rows) * columns + i % columns; };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      mesh.triangles.insert(mesh.triangles.end(), {{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                                                   {at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  mesh.regions = {{1, {"skin"}}};
  return mesh;
}

Mesh torus_scan() {
  return scan(72, 32, true, [](int i, int j) {
    const double a = 2 * std::numbers::pi * i / 72, b = 2 * std::numbers::pi * j / 32;
    const double r = 1 + 0.4 * std::cos(b);
    return Vec3{r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)};
  });
}

MeshResult mesh_scan(const Mesh& scan, double size, int threads = 1) {
  MeshProblem problem = problem_of(TriangleModel{scan}, size);
  return mesh(problem, "DBCQO", {.threads = threads});
}

/// Fewer irregular vertices than before; no line is left of a cut, and all else is as it should be.
void expect_fewer(const Mesh& scan, double size, const std::function<double(const Vec3&)>& off) {
  const MeshResult result = mesh_scan(scan, size);
  const auto count = [&](const char* key) { return result.log.summaries.get<long long>("across_cuts", key); };
  EXPECT_EQ(count("faces"), 1);
  EXPECT_EQ(count("taken"), 1);
  EXPECT_LT(count("irregular_after"), count("irregular_before"));
  EXPECT_EQ(result.metrics.values.at("n_irregular"), static_cast<double>(count("irregular_after")));
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_TRUE(result.mesh.lines.empty());
  EXPECT_EQ(result.mesh.regions.at(0).names, scan.regions[0].names);
  EXPECT_GT(result.metrics.values.at("eta_worst"), 0.5);
  EXPECT_GT(result.metrics.values.at("tau"), 90);
  double farthest = 0;
  for (const Vec3& p : result.mesh.points) farthest = std::max(farthest, off(p));
  EXPECT_LT(farthest, 0.008);  // as deep as the facets lie
  const MeshResult parallel = mesh_scan(scan, size, 3);
  EXPECT_EQ(parallel.mesh.points, result.mesh.points);
  EXPECT_EQ(parallel.mesh.quads, result.mesh.quads);
}

TEST(AcrossCuts, ATorusGetsFewerIrregularVertices) {
  expect_fewer(torus_scan(), 0.06,
               [](const Vec3& p) { return std::abs(std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.4); });
}

TEST(AcrossCuts, ASphereNeedsNoOtherCuts) {
  const MeshResult result = mesh_scan(round_sphere(24).fine, 0.06);
  EXPECT_EQ(result.metrics.values.at("n_irregular"), 8) << "as few as on a cube";
  EXPECT_EQ(result.log.summaries.get<long long>("across_cuts", "taken"), 0);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_GT(result.metrics.values.at("eta_worst"), 0.5);
  EXPECT_GT(result.metrics.values.at("tau"), 90);
}

TEST(AcrossCuts, NothingHappensToAnOpenScanWithoutCuts) {
  const Mesh bowl = scan(30, 30, false, [](int i, int j) {
    const double x = i / 30.0 - 0.5, y = j / 30.0 - 0.5;
    return Vec3{x, y, x * x + y * y};
  });
  const MeshResult result = mesh_scan(bowl, 0.04);
  EXPECT_FALSE(result.log.summaries.has("across_cuts"));
  EXPECT_FALSE(result.mesh.lines.empty());
}

/// Halves that are images must stay so.
TEST(AcrossCuts, NothingHappensToSymmetricSurfaces) {
  MeshProblem problem = problem_of(TriangleModel{torus_scan()}, 0.1);
  problem.symmetry.planes = {{{0, 0, 0}, {0, 0, 1}}};
  const MeshResult result = mesh(problem, "DBCQO");
  EXPECT_EQ(result.log.summaries.get<long long>("across_cuts", "faces"), 0);
  EXPECT_EQ(result.log.summaries.get<long long>("across_cuts", "taken"), 0);
  EXPECT_EQ(result.mesh.periodic.size(), 0u);
}

TEST(AcrossCuts, LinesAndPointsInsideStay) {
  MeshProblem problem = problem_of(TriangleModel{torus_scan()}, 0.06);
  const Vec3 point{0, -1.4, 0};
  const std::vector<Vec3> rib{{1.4, 0, 0}, {1.4 * std::cos(0.5), 1.4 * std::sin(0.5), 0}};
  problem.surface.embed = {{rib, "rib", "test"}, {{point}, "sensor", "test"}};
  const MeshResult result = mesh(problem, "DBCQO", {.threads = 1});
  EXPECT_EQ(result.log.summaries.get<long long>("across_cuts", "taken"), 1);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  const Mesh& mesh = result.mesh;
  std::map<int, int> uses;
  for (const auto& line : lines_named(mesh, "rib"))
    for (const int v : line) ++uses[v];
  EXPECT_GT(uses.size(), 8u);
  for (const Vec3& end : rib)
    EXPECT_TRUE(std::ranges::any_of(uses, [&](const auto& use) {
      return use.second == 1 && norm(mesh.points[use.first] - end) < 0.003;
    }));
  ASSERT_EQ(mesh.named_points.size(), 1u);
  EXPECT_LT(norm(mesh.points[mesh.named_points[0].point] - point), 0.003);
}

/// Solids that a ball becomes if its points move along their rays.
Mesh star(int n, const std::function<double(const Vec3&)>& radius) {
  Mesh mesh = round_sphere(n).fine;
  for (Vec3& p : mesh.points) p = radius(p) * p;
  return mesh;
}

Mesh bumpy_ball() {
  return star(20, [](const Vec3& p) {
    return 1 + 0.4 * std::sin(5 * p.x + 1) * std::sin(6 * p.y + 0.5) * std::sin(5 * p.z + 2);
  });
}

/// Two blunt tubes, one along x and one along y, that cross.
Mesh crossing_tubes() {
  return star(16, [](const Vec3& p) {
    const auto along = [](double axis, double a, double b) {
      return std::pow(axis / 2, 8) + std::pow(std::hypot(a, b) / 0.9, 8);
    };
    return 1 / std::pow(std::min(along(p.x, p.y, p.z), along(p.y, p.z, p.x)), 1.0 / 8);
  });
}

class ScansOf : public testing::TestWithParam<Mesh (*)()> {};

TEST_P(ScansOf, LargeFacesPayMoreForRegularity) {
  MeshProblem problem = problem_of(TriangleModel{GetParam()()}, 0.12);
  const auto irregular = [&] {
    const MeshResult result = mesh(problem, "best", {.threads = 1});
    EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
    EXPECT_GT(result.metrics.values.at("eta_mean"), 0.89);
    return result.metrics.values.at("n_irregular");
  };
  const double now = irregular();
  problem.options.set("regularity.tolerance", 0.25).set("regularity.quads", 200);
  EXPECT_LT(now, irregular());
}

INSTANTIATE_TEST_SUITE_P(AcrossCuts, ScansOf, testing::Values(bumpy_ball, crossing_tubes));

}  // namespace
}  // namespace delquad
