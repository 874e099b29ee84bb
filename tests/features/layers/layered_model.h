// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {

inline LayerSpec layer_on(std::vector<std::string> on, double first, int number, double growth = 1.2) {
  LayerSpec spec;
  spec.on = std::move(on);
  spec.first = first;
  spec.number = number;
  spec.growth = growth;
  return spec;
}

inline std::vector<Vec2> rectangle(Vec2 low, Vec2 high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

inline Vec2 flat(const Vec3& p) { return {p.x, p.y}; }

inline long long count_of(const MeshResult& result, const std::string& key) {
  return result.log.summaries.get<long long>("layers", key);
}

inline int lines_on(const Mesh& mesh, const std::vector<std::string>& names) {
  int n = 0;
  for (const int curve : mesh.line_curve)
    n += std::ranges::any_of(mesh.curves[curve].names,
                             [&](const auto& name) { return std::ranges::count(names, name) > 0; });
  return n;
}

/// Every corner of every quad turns left, exactly; the areas add up to the domain's.
inline void expect_good_quads(const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>());
  const Mesh& mesh = result.mesh;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k)
      EXPECT_GT(orient2d(flat(mesh.points[q[k]]), flat(mesh.points[q[(k + 1) % 4]]),
                         flat(mesh.points[q[(k + 2) % 4]])),
                0);
  double area = 0, inside = 0;
  const auto swept = [&](int a, int b) { return cross(mesh.points[a], mesh.points[b]).z / 2; };
  std::set<std::pair<int, int>> sides;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) {
      area += swept(q[k], q[(k + 1) % 4]);
      sides.insert({q[k], q[(k + 1) % 4]});
    }
  for (const auto& [a, b] : mesh.lines)
    if (!sides.contains({b, a})) inside += swept(a, b);
  EXPECT_NEAR(area, inside, 1e-9 * inside);
}

/// And the layers have each quad that they should.
inline void expect_layers(const MeshProblem& problem, const MeshResult& result) {
  expect_good_quads(result);
  std::vector<std::string> names;
  for (const LayerSpec& layer : problem.layers) names.insert(names.end(), layer.on.begin(), layer.on.end());
  const long long columns = lines_on(result.mesh, names), fans = count_of(result, "fans");
  const auto n = static_cast<long long>(layer_heights(problem.layers[0]).size());
  EXPECT_EQ(count_of(result, "columns"), columns);
  EXPECT_EQ(count_of(result, "quads"), n * columns + fans + 2 * fans * (n - 1));
}

/// Heights of the quads at the lines of a curve: areas by lengths.
inline std::vector<double> first_heights(const Mesh& mesh, const std::string& name) {
  std::set<std::pair<int, int>> lines;
  for (const auto& [a, b] : lines_named(mesh, name)) lines.insert(std::minmax(a, b));
  std::vector<double> heights;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) {
      if (!lines.contains(std::minmax(q[k], q[(k + 1) % 4]))) continue;
      const Vec2 a = flat(mesh.points[q[k]]), b = flat(mesh.points[q[(k + 1) % 4]]);
      const Vec2 c = flat(mesh.points[q[(k + 2) % 4]]);
      heights.push_back(cross(b - a, c - a) / norm(b - a));
    }
  return heights;
}

/// The chord is 1; the far field ten of them away.
inline MeshProblem naca0012(bool is_sharp, double first) {
  const double last = is_sharp ? 0.1036 : 0.1015;
  const auto half = [last](double s) {
    return 0.6 * (0.2969 * s - 0.1260 * s * s - 0.3516 * std::pow(s, 4) + 0.2843 * std::pow(s, 6) -
                  last * std::pow(s, 8));
  };
  ModelMaker model = ModelMaker().rectangle({-10, -10}, {11, 10}, {"far"});
  const double tail = is_sharp ? 0 : half(1);
  const auto side = [&](double sign) {
    return make_parametric_curve(
        [=](double s) {
          return Vec2{s * s, s == 1 ? sign * tail : sign * half(s)};
        },
        0, 1);
  };
  std::vector<ModelMaker::Shape> shapes = {side(1), side(-1)};
  if (!is_sharp) shapes.insert(shapes.begin() + 1, make_segment({1, tail}, {1, -tail}));
  model.loop(shapes, "", {"airfoil"}).loops.back().is_hole = true;
  LayerSpec layer = layer_on({"airfoil"}, first, 0);
  layer.thickness = 0.02;
  MeshProblem problem = model.problem(1, {layer});
  problem.size.sources = {{{0, 0, 0}, {1, 0, 0}, 0.015, 1, 0.1, 8},
                          {{0, 0, 0}, {0, 0, 0}, 0.004, 1, 0.01, 8},
                          {{1, 0, 0}, {1, 0, 0}, 0.002, 1, 0.005, 8}};
  return problem;
}

}  // namespace delquad
