// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The wall of a tube of radius 1 and height 2, with a corner on each rim.
TriangleModel tube_wall() {
  constexpr int kAround = 48, kHigh = 6;
  Mesh mesh;
  for (int j = 0; j <= kHigh; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      mesh.points.push_back({std::cos(angle), std::sin(angle), 2.0 * j / kHigh});
    }
  for (int j = 0; j < kHigh; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, b, b + kAround});
      mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  mesh.regions.push_back({1, {"wall"}});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return {mesh};
}

MeshProblem problem_of(Model model, double size, std::vector<CurveDivision> divisions) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.divisions = std::move(divisions);
  return problem;
}

/// Lengths of the edges of each curve, by its tag, in the lines' order.
std::map<int, std::vector<double>> edges_by_tag(const Mesh& mesh) {
  std::map<int, std::vector<double>> lengths;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto& [a, b] = mesh.lines[l];
    lengths[mesh.curves[mesh.line_curve[l]].tag].push_back(norm(mesh.points[b] - mesh.points[a]));
  }
  return lengths;
}

TEST(DividedCurves, OfSurfacesKeepTheirEdges) {
  const MeshResult r =
      mesh(problem_of(tube_wall(), 0.2, {{"curve_1", 20, 1, 1}, {"curve_2", 44, 1, 1}}), "DBCO");
  const auto lengths = edges_by_tag(r.mesh);
  ASSERT_EQ(lengths.at(1).size(), 20u);
  ASSERT_EQ(lengths.at(2).size(), 44u);
  for (const double length : lengths.at(2)) EXPECT_NEAR(length, 2 * std::numbers::pi / 44, 2e-3);
  EXPECT_TRUE(r.mesh.triangles.empty());
}

TEST(DividedCurves, StayAsTheyAreInSpace) {
  // The vertices of edges and their corners in a box's faces slide with O, but not these.
  Mesh box;
  for (const double z : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double x : {0.0, 2.0}) box.points.push_back({x, y, z});
  box.quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  box.quad_region.assign(6, 0);
  box.regions.push_back({1, {}});
  const MeshResult r = mesh(problem_of(TriangleModel{box}, 0.11, {{"curve_3", 12, 1.2, 1}}), "DBCO");
  const std::vector<double> lengths = edges_by_tag(r.mesh).at(3);
  ASSERT_EQ(lengths.size(), 12u);
  for (std::size_t k = 1; k < lengths.size(); ++k) EXPECT_NEAR(lengths[k] / lengths[k - 1], 1.2, 1e-6);
  EXPECT_TRUE(r.mesh.triangles.empty());
}

TEST(DividedCurves, ThatMakeAnOddBoundaryAreRefused) {
  expect_refused(problem_of(tube_wall(), 0.2, {{"curve_1", 21, 1, 1, "d 1"}, {"curve_2", 44, 1, 1, "d 2"}}),
                 "DBCO", {"'wall' with an odd number", "curve"});
  expect_refused(problem_of(tube_wall(), 0.2, {{"rim", 20, 1, 1, "d 1"}}), "DBCO",
                 {"d 1: no curve is called 'rim'"});
}

TEST(DividedCurves, OfGivenLinesAreRefused) {
  LineModel square;
  square.mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.mesh.lines = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  square.mesh.line_curve = {0, 0, 0, 0};
  square.mesh.curves = {{1, {"rim"}}};
  expect_refused(problem_of(square, 0.2, {{"rim", 8, 1, 1, "d 1"}}), "DBCO",
                 {"d 1: 'rim' cannot be divided"});
}

TEST(DividedCurves, TellWhereTheTipOfAConeTakesTheirLastNodes) {
  const Mesh cone = testing_support::cone(24, 100, 0.05).fine;
  Mesh surface = cone;
  surface.lines.clear();
  surface.line_curve.clear();
  surface.curves = {{7, {"seam"}}};
  std::map<double, int> along;  // points of a generator, by their height
  for (std::size_t i = 0; i < cone.points.size(); ++i)
    if (const Vec3& p = cone.points[i]; std::abs(p.y) < 1e-12 && p.x >= 0) along[p.z] = static_cast<int>(i);
  for (auto at = along.begin(); std::next(at) != along.end(); ++at) {
    surface.lines.push_back({at->second, std::next(at)->second});
    surface.line_curve.push_back(0);
  }
  constexpr std::size_t kAsked = 60;
  const MeshResult r = mesh(problem_of(TriangleModel{surface}, 1.0 / 60, {{"seam", kAsked, 1, 1}}), "DB");
  const auto seam = std::ranges::find_if(
      r.mesh.curves, [](const Entity& curve) { return curve.names == std::vector<std::string>{"seam"}; });
  ASSERT_NE(seam, r.mesh.curves.end());
  const std::size_t left = edges_by_tag(r.mesh)[seam->tag].size();
  EXPECT_LT(left, kAsked);
  EXPECT_TRUE(is_reported(r.warnings, fmt::format("curve {} gets {} edges, not 60", seam->tag, left)));
}

}  // namespace
}  // namespace delquad
