#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delquad/mesher.h"
#include "tests/support/expect_input_error.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;

PlanarModel quarter_ring() {
  PlanarModel model;
  model.curves = {{make_arc({0, 0}, 1, 0, kPi / 2), "inner", {}},
                  {make_segment({0, 1}, {0, 2}), "left", {}},
                  {make_arc({0, 0}, 2, 0, kPi / 2), "outer", {}},
                  {make_segment({1, 0}, {2, 0}), "right", {}}};
  model.loops = {{{0, 1, 2, 3}, "ring", {}}};
  return model;
}

/// Blocks side by side, which bend, and a free face at their end.
PlanarModel row_of_blocks(int n) {
  PlanarModel model;
  const auto low = [](int i) { return Vec2{i + 0.2 * std::sin(3.0 * i), 0.2 * std::sin(1.0 * i)}; };
  const auto high = [&](int i) { return Vec2{low(i).x + 0.1, 1 + 0.2 * std::cos(1.0 * i)}; };
  for (int i = 0; i <= n; ++i) model.curves.push_back({make_segment(low(i), high(i)), "wall", {}});
  for (int i = 0; i < n; ++i) {
    const int first = static_cast<int>(model.curves.size());
    model.curves.push_back({make_segment(low(i), low(i + 1)), "floor", {}});
    model.curves.push_back({make_segment(high(i), high(i + 1)), "roof", {}});
    model.loops.push_back({{first, i + 1, first + 1, i}, "block", {}});
  }
  const Vec2 a = low(n), b = high(n);
  model.curves.push_back({make_polyline({a, {a.x + 2, -1}, {a.x + 2.5, 1.6}, b}), "end", {}});
  model.loops.push_back({{n, static_cast<int>(model.curves.size()) - 1}, "free", {}});
  return model;
}

/// A square with a hole, cut into four blocks from the corners on.
PlanarModel plate_of_blocks() {
  PlanarModel model;
  const auto at = [](double r, int k) {
    const double angle = kPi / 4 + k * kPi / 2;
    return Vec2{r * std::cos(angle), r * std::sin(angle)};
  };
  for (int k = 0; k < 4; ++k) {
    model.curves.push_back(
        {make_arc({0, 0}, 0.4, kPi / 4 + k * kPi / 2, kPi / 4 + (k + 1) * kPi / 2), "hole", {}});
    model.curves.push_back({make_segment(at(1.2, k), at(1.2, k + 1)), "side", {}});
    model.curves.push_back({make_segment(at(0.4, k), at(1.2, k)), {}, {}});
  }
  for (int k = 0; k < 4; ++k)
    model.loops.push_back({{3 * k, 3 * ((k + 1) % 4) + 2, 3 * k + 1, 3 * k + 2}, "block", {}});
  return model;
}

MeshProblem mapped_problem(PlanarModel model, double size, MappedSpec mapped) {
  MeshProblem problem;
  problem.model = std::move(model);
  problem.size.field = make_constant_size(size);
  problem.mapped = std::move(mapped);
  return problem;
}

/// Inner nodes of these regions with other than four quads.
int irregular_inside(const Mesh& mesh, const std::string& region) {
  std::vector<int> quads(mesh.points.size(), 0), of_others(mesh.points.size(), 0);
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : mesh.quads[q]) {
      ++quads[v];
      if (mesh.regions[mesh.quad_region[q]].names != std::vector{region}) of_others[v] = 1;
    }
  for (const auto& line : mesh.lines)
    for (const int v : line) of_others[v] = 1;
  int irregular = 0;
  for (std::size_t v = 0; v < quads.size(); ++v) irregular += of_others[v] == 0 && quads[v] != 4;
  return irregular;
}

TEST(MappedFaces, ARingIsAGrid) {
  for (const std::string word : {"DB", "DBCO", "FLBCO"}) {
    for (const MappedSpec& spec : {MappedSpec{{"ring"}}, MappedSpec{{}, true}}) {
      const MeshResult r = mesh(mapped_problem(quarter_ring(), 0.1, spec), word);
      EXPECT_EQ(irregular_inside(r.mesh, "ring"), 0);
      const auto along = std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 0);
      EXPECT_EQ(along, std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 2));
      EXPECT_EQ(r.mesh.quads.size(), along * 10u);
      // The grid is that of polar coordinates.
      for (const Vec3& x : r.mesh.points) {
        const double step = norm(x) * 10;
        EXPECT_NEAR(step, std::round(step), 1e-9);
      }
    }
  }
  const MeshResult plain = mesh(mapped_problem(quarter_ring(), 0.1, {}));
  EXPECT_GT(irregular_inside(plain.mesh, "ring"), 0);
}

TEST(MappedFaces, ChainsAgreeOnTheirEdges) {
  const MeshResult r = mesh(mapped_problem(row_of_blocks(10), 0.13, {{"block"}}));
  EXPECT_EQ(irregular_inside(r.mesh, "block"), 0);
  EXPECT_TRUE(r.mesh.triangles.empty());
  std::vector<int> edges(r.mesh.curves.size(), 0);
  for (const int c : r.mesh.line_curve) ++edges[c];
  for (int i = 1; i <= 10; ++i) EXPECT_EQ(edges[i], edges[0]);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(edges[11 + 2 * i], edges[12 + 2 * i]);
}

TEST(MappedFaces, AroundAHole) {
  const MeshResult r = mesh(mapped_problem(plate_of_blocks(), 0.05, {{"block"}}));
  EXPECT_EQ(r.metrics.values.at("d4"), 100);
  EXPECT_GT(r.metrics.values.at("eta_worst"), 0.4);
  MeshProblem divided = mapped_problem(plate_of_blocks(), 0.05, {{"block"}});
  divided.divisions = {{"hole", 9, 1, 1, "d 1"}, {"curve_3", 12, 1.2, 1, "d 2"}};
  const MeshResult d = mesh(divided);
  EXPECT_EQ(d.mesh.quads.size(), 4u * 9 * 12);
  divided.divisions.push_back({"curve_2", 10, 1, 1, "d 3"});
  expect_input_error([&] { mesh(divided); }, {"'block' with sides that do not match"});
}

TEST(MappedFaces, WhatCannotBeAGridIsRefused) {
  const auto refused = [](PlanarModel model, MappedSpec spec, std::initializer_list<const char*> says) {
    spec.where = "m 1";
    expect_input_error([&] { mesh(mapped_problem(std::move(model), 0.2, spec)); }, says);
  };
  refused(quarter_ring(), {{"rong"}}, {"m 1: no region is called 'rong'; did you mean 'ring'?"});
  PlanarModel disk;
  disk.curves = {{make_circle({0, 0}, 1), "rim", {}}};
  disk.loops = {{{0}, "disk", {}}};
  refused(disk, {{"disk"}}, {"'disk' cannot be a grid: its outline has 1 corner"});
  PlanarModel holed = quarter_ring();
  holed.curves.push_back({make_circle({1, 1}, 0.2), "hole", {}});
  holed.loops.push_back({{4}, {}, {}});
  refused(holed, {{"ring"}}, {"'ring' cannot be a grid: something lies inside of it"});
  EXPECT_GT(mesh(mapped_problem(holed, 0.2, {{}, true})).mesh.quads.size(), 0u);
  PlanarModel arrow = polygons({{{0, 0}, {1, 1}, {0, 0.2}, {-1, 1}}});
  arrow.loops[0].region = "arrow";
  refused(arrow, {{"arrow"}}, {"'arrow' cannot be a grid: it would fold"});
  MeshProblem on_surface = mapped_problem(arrow, 0.2, {{"arrow"}, false, "m 1"});
  on_surface.model = ExampleModel{"sphere"};
  expect_input_error([&] { mesh(on_surface); }, {"m 1: grids are for planar models of curves"});
}

}  // namespace
}  // namespace delquad
