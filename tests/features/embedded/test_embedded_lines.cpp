// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

/// The ends of the way that the lines of this name make.
std::vector<Vec3> ends_of_way(const Mesh& mesh, const std::string& name) {
  std::map<int, int> uses;
  for (const auto& line : lines_named(mesh, name))
    for (const int v : line) ++uses[v];
  std::vector<Vec3> ends;
  for (const auto& [v, n] : uses) {
    EXPECT_LE(n, 2) << name;
    if (n == 1) ends.push_back(mesh.points[v]);
  }
  return ends;
}

bool is_near(const Vec3& x, const std::vector<Vec3>& all, double distance) {
  return std::ranges::any_of(all, [&](const Vec3& y) { return norm(y - x) <= distance; });
}

MeshProblem sphere_problem() { return problem_of(TriangleModel{round_sphere(24).fine}, 0.15); }

void expect_embedded(const MeshProblem& problem, const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_TRUE(result.mesh.triangles.empty());
  std::vector<Vec3> named;
  for (const NamedPoint& point : result.mesh.named_points) named.push_back(result.mesh.points[point.point]);
  for (const EmbeddedLine& line : problem.surface.embed) {
    constexpr double kFit = 5e-3;  // the triangulation is within this of the sphere
    if (line.points.size() == 1) {
      EXPECT_TRUE(is_near(line.points[0], named, kFit)) << line.name;
      continue;
    }
    const std::vector<Vec3> ends = ends_of_way(result.mesh, line.name);
    ASSERT_EQ(ends.size(), 2u) << line.name;
    for (const Vec3& x : {line.points.front(), line.points.back()})
      EXPECT_TRUE(is_near(x, ends, kFit)) << line.name;
  }
}

TEST(EmbeddedLines, RandomSetsOnASphereBecomeEdgesAndNodes) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 random(seed);
    const auto on_sphere = [&](const Vec3& near, double reach) {
      std::uniform_real_distribution<double> part(-reach, reach);
      const Vec3 x = near + Vec3{part(random), part(random), part(random)};
      return 1 / norm(x) * x;
    };
    MeshProblem problem = sphere_problem();
    for (int k = 0; k < 12; ++k) {
      const Vec3 a = on_sphere({0.01, 0, 0}, 1);
      EmbeddedLine line{{a}, "line " + std::to_string(k), "test"};
      if (k % 3 != 0) line.points.push_back(on_sphere(a, 0.5));
      problem.surface.embed.push_back(line);
    }
    expect_embedded(problem, mesh(problem, "DBCO"));
  }
}

TEST(EmbeddedLines, GetSizesByName) {
  MeshProblem problem = sphere_problem();
  // The chord is far below the surface.
  const double s = std::sqrt(0.5);
  problem.surface.embed = {{{{1, 0, 0}, {0, 1, 0}}, "rib", "test"}, {{{0, -s, -s}}, "point", "test"}};
  const auto longest_at_rib = [](const Mesh& mesh) {
    double longest = 0;
    for (const auto& [a, b] : lines_named(mesh, "rib"))
      longest = std::max(longest, norm(mesh.points[b] - mesh.points[a]));
    return longest;
  };
  const auto longest_at_point = [](const Mesh& mesh) {
    const int point = mesh.named_points.at(0).point;
    double longest = 0;
    for (const auto& quad : mesh.quads)
      for (int k = 0; k < 4; ++k)
        if (quad[k] == point || quad[(k + 1) % 4] == point)
          longest = std::max(longest, norm(mesh.points[quad[k]] - mesh.points[quad[(k + 1) % 4]]));
    return longest;
  };
  const Mesh plain = mesh(problem, "DBCO").mesh;
  EXPECT_GT(longest_at_rib(plain), 0.1);
  EXPECT_GT(longest_at_point(plain), 0.08);
  problem.size.named = {{.name = "rib", .size = 0.03}, {.name = "point", .size = 0.02}};
  const MeshResult fine = mesh(problem, "DBCO");
  EXPECT_TRUE(fine.soundness.sound());
  EXPECT_LT(longest_at_rib(fine.mesh), 1.4 * 0.03);
  EXPECT_LT(longest_at_point(fine.mesh), 2 * 0.02);
  problem.size.named[0].name = "rip";
  expect_refused(problem, "DBCO", {"nothing is called 'rip'", "'rib'"});
}

TEST(EmbeddedLines, NamedPointsAndLinesOfATriangulationStay) {
  MeshProblem problem;
  Mesh plate = box(4);
  // The edges of the triangles that leave an inner point of a side.
  int inside = -1;
  for (std::size_t v = 0; v < plate.points.size(); ++v)
    if (plate.points[v] == Vec3{0.5, 0.5, 1}) inside = static_cast<int>(v);
  ASSERT_GE(inside, 0);
  int next = -1, other = -1;
  for (const auto& t : plate.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] == inside) next = t[(k + 1) % 3];
  for (std::size_t v = 0; v < plate.points.size(); ++v)
    if (plate.points[v] == Vec3{0.25, 0.5, 0}) other = static_cast<int>(v);
  ASSERT_GE(other, 0);
  plate.lines = {{inside, next}};
  plate.line_curve = {0};
  plate.curves = {{1, {"scratch"}}};
  plate.named_points = {{other, {1, {"sensor"}}}};
  const Vec3 from = plate.points[inside], to = plate.points[next], sensor = plate.points[other];
  problem.model = TriangleModel{plate};
  problem.size.field = make_constant_size(0.125);
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_TRUE(result.soundness.sound());
  const std::vector<Vec3> ends = ends_of_way(result.mesh, "scratch");
  ASSERT_EQ(ends.size(), 2u);
  for (const Vec3& x : {from, to}) EXPECT_TRUE(is_near(x, ends, 1e-12));
  ASSERT_EQ(result.mesh.named_points.size(), 1u);
  EXPECT_EQ(result.mesh.points[result.mesh.named_points[0].point], sensor);
}

TEST(EmbeddedLines, EveryNumberOfThreadsMakesTheSameMesh) {
  MeshProblem problem = sphere_problem();
  problem.surface.embed = {{{{1, 0, 0}, {0, 1, 0}, {0, 0.6, 0.8}}, "way", "test"},
                           {{{0, 0, -1}}, "pole", "test"}};
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(mesh(problem, "DBCO", one).mesh.points, mesh(problem, "DBCO", four).mesh.points);
}

TEST(EmbeddedLines, PlanarModelsRefuseThem) {
  MeshProblem problem = problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}), 0.5);
  problem.surface.embed = {{{{0.5, 0.5, 0}}, "p", "test"}};
  expect_refused(problem, "DBCO", {"the model is planar", "embed"});
}

}  // namespace
}  // namespace delquad
