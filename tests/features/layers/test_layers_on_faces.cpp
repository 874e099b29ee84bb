// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

constexpr const char* kWord = "DBCQO";

LayerSpec layer_into(std::vector<std::string> on, std::vector<std::string> into, double first, int number) {
  LayerSpec spec = layer_on(std::move(on), first, number, 1.3);
  spec.into = std::move(into);
  return spec;
}

MeshProblem bracket(std::vector<LayerSpec> layers) {
  MeshProblem problem = problem_of(ExampleModel{"bracket"}, 4);
  problem.layers = std::move(layers);
  return problem;
}

/// Distances, from the lines of curves with these numbers, of the nodes across quads of a face.
std::vector<double> heights_at(const Mesh& mesh, const std::set<int>& curves, int face) {
  std::set<std::pair<int, int>> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (curves.contains(mesh.curves[mesh.line_curve[l]].tag))
      lines.insert(std::minmax(mesh.lines[l][0], mesh.lines[l][1]));
  std::vector<double> heights;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) {
      const auto v = [&](int i) { return mesh.quads[q][(k + i) % 4]; };
      if (mesh.regions[mesh.quad_region[q]].tag != face || !lines.contains(std::minmax(v(0), v(1)))) continue;
      const Vec3 a = mesh.points[v(0)], along = mesh.points[v(1)] - a;
      for (const int i : {2, 3}) heights.push_back(norm(cross(along, mesh.points[v(i)] - a)) / norm(along));
    }
  return heights;
}

void expect_heights(const Mesh& mesh, const std::set<int>& curves, int face, double first, double tolerance) {
  const std::vector<double> heights = heights_at(mesh, curves, face);
  EXPECT_GT(heights.size(), 8u);
  for (const double h : heights) EXPECT_NEAR(h, first, tolerance * first);
}

void expect_sound(const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>());
}

TEST(LayersOnFaces, StandAroundHolesOfAPlate) {
  const std::vector<std::string> holes = {"curve_7", "curve_8", "curve_9", "curve_10"};
  MeshProblem plate = bracket({layer_into(holes, {"base"}, 0.01, 6)});
  for (const std::string& hole : holes) plate.divisions.push_back({.name = hole, .edges = 16});
  const MeshResult result = mesh(plate, kWord);
  expect_sound(result);
  expect_heights(result.mesh, {7, 8, 9, 10}, 1, 0.01, 1e-9);
  EXPECT_EQ(count_of(result, "quads"), 6 * count_of(result, "columns"));
  EXPECT_EQ(result.log.summaries.number("layers", "least_scale"), 1);
}

TEST(LayersOnFaces, StandOnAllFacesOfACurve) {
  const MeshResult result = mesh(bracket({layer_on({"curve_7"}, 0.05, 3)}), kWord);
  expect_sound(result);
  expect_heights(result.mesh, {7}, 1, 0.05, 1e-9);
  expect_heights(result.mesh, {7}, 8, 0.05, 1e-4);
}

TEST(LayersOnFaces, RunAroundATube) {
  const MeshResult result = mesh(bracket({layer_into({"curve_43", "curve_51"}, {"bore"}, 0.05, 5)}), kWord);
  expect_sound(result);
  expect_heights(result.mesh, {43, 51}, 19, 0.05, 1e-3);
}

TEST(LayersOnFaces, EndOnCurvesOfOtherFaces) {
  const MeshResult result = mesh(bracket({layer_on({"curve_1"}, 0.02, 6)}), kWord);
  expect_sound(result);
  expect_heights(result.mesh, {1}, 1, 0.02, 1e-9);
  expect_heights(result.mesh, {1}, 2, 0.02, 1e-9);
}

TEST(LayersOnFaces, AreSoundOnSaddlesAndFillets) {
  MeshProblem drilled = problem_of(ExampleModel{"cross_drilled"}, 3);
  drilled.layers = {layer_on({"curve_26"}, 0.1, 4)};
  const MeshResult result = mesh(drilled, kWord);
  expect_sound(result);
  for (const int face : {6, 10}) expect_heights(result.mesh, {26}, face, 0.1, 0.02);
}

TEST(LayersOnFaces, EndOnJaggedCuts) {
  MeshProblem fins = problem_of(ExampleModel{"fins"}, 4);
  fins.layers = {layer_into({"curve_43", "curve_45"}, {"region_5"}, 0.05, 3)};
  const MeshResult result = mesh(fins, kWord);
  expect_sound(result);
  expect_heights(result.mesh, {43, 45}, 5, 0.05, 0.02);
}

TEST(LayersOnFaces, FollowTriangulations) {
  MeshProblem problem;
  problem.layers = {layer_on({"curve_1"}, 0.005, 5)};
  const MeshResult result = testing_support::meshed(testing_support::bump(24, 0.4), 0.1, kWord, problem);
  expect_sound(result);
  expect_heights(result.mesh, {1}, 1, 0.005, 0.02);
}

TEST(LayersOnFaces, AreMirrored) {
  const std::vector<std::string> holes = {"curve_7", "curve_8", "curve_9", "curve_10"};
  MeshProblem plate = bracket({layer_into(holes, {"base"}, 0.05, 3)});
  plate.symmetry.automatic = true;
  const MeshResult result = mesh(plate, kWord);
  expect_sound(result);
  expect_heights(result.mesh, {7, 8, 9, 10}, 1, 0.05, 1e-4);
  EXPECT_GT(result.metrics.values.at("edge_min"), 0.03) << "layers do not count, on both sides";
  plate.layers[0].on = {"curve_7"};
  expect_refused(plate, "DB", {"curve 7", "mirror images", "expected it on both"});
}

TEST(LayersOnFaces, EndAtPeriodicCurves) {
  Mesh wave = testing_support::grid_surface({24, 24}, [](double u, double v) {
                return Vec3{u, v, 0.1 * std::cos(2 * std::numbers::pi * u) * (1 + v)};
              }).fine;
  wave.curves = {{1, {"west"}}, {2, {"east"}}, {3, {"south"}}, {4, {"north"}}};
  for (std::size_t l = 0; l < wave.lines.size(); ++l) {
    const Vec3 x = 0.5 * (wave.points[wave.lines[l][0]] + wave.points[wave.lines[l][1]]);
    wave.line_curve[l] = x.x < 1e-9 ? 0 : x.x > 1 - 1e-9 ? 1 : x.y < 1e-9 ? 2 : 3;
  }
  MeshProblem problem = problem_of(TriangleModel{std::move(wave)}, 0.05);
  problem.layers = {layer_on({"south"}, 0.005, 5)};
  problem.periodic = {{"west", "east", {.shift = {1, 0, 0}}, "periodic"}};
  const MeshResult result = mesh(problem, kWord);
  expect_sound(result);
  EXPECT_EQ(count_of(result, "quads"), 5 * count_of(result, "columns"));
  ASSERT_EQ(result.mesh.periodic.size(), 1u);
  const PeriodicNodes& pair = result.mesh.periodic[0];
  EXPECT_GT(pair.nodes.size(), 5u + 1 / 0.05 / 2);
  for (const auto& [node, master] : pair.nodes)
    EXPECT_EQ(result.mesh.points[node], pair.motion(result.mesh.points[master]));
}

TEST(LayersOnFaces, RefuseWhatCannotBe) {
  expect_refused(bracket({layer_on({"curve_7"}, 200, 3)}), "DB", {"thick", "wide", "[no-place-for-layers]"});
  expect_refused(bracket({layer_on({"curve_999"}, 0.1, 3)}), "DB", {"no curve is called 'curve_999'"});
  expect_refused(bracket({layer_on({"holes"}, 0.1, 3)}), "DB", {"'holes' names faces", "[unknown-name]"});
  MeshProblem divided = bracket({layer_into({"curve_1"}, {"base"}, 0.1, 3)});
  divided.divisions = {{.name = "curve_2", .edges = 6}};
  expect_refused(divided, "DB", {"'divide'", "[layer-at-a-divided-curve]"});
}

}  // namespace
}  // namespace delquad
