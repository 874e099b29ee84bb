// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/patterns.h"
#include "metrics/metrics.h"
#include "metrics/regularity.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

using Burgers = std::map<std::array<int, 2>, long long>;

Mesh of_quads(std::vector<Vec3> points, std::vector<std::array<int, 4>> quads) {
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.quads = std::move(quads);
  mesh.quad_region.assign(mesh.quads.size(), 0);
  mesh.regions = {{1, {}}};
  return mesh;
}

void expect_regularity(const Mesh& mesh, int necessary, int beyond, int unpaired, const Burgers& burgers) {
  const MeshMetrics metrics = evaluate_metrics(mesh, nullptr);
  EXPECT_EQ(metrics.values.at("n_necessary"), necessary);
  EXPECT_EQ(metrics.values.at("n_beyond"), beyond);
  ASSERT_TRUE(metrics.pairs);
  EXPECT_EQ(2 * metrics.pairs->pairs, beyond);
  EXPECT_EQ(metrics.pairs->unpaired, unpaired);
  EXPECT_EQ(metrics.pairs->burgers, burgers);
}

/// A regular polygon of n quads around its center, with the corners of the quads.
Mesh star(int n) {
  std::vector<Vec3> points = {{0, 0, 0}};
  std::vector<std::array<int, 4>> quads;
  for (int k = 0; k < 2 * n; ++k) {
    const double t = k * std::numbers::pi / n, r = k % 2 == 0 ? 1 : std::cos(std::numbers::pi / n);
    points.push_back({r * std::cos(t), r * std::sin(t), 0});
  }
  for (int k = 0; k < n; ++k) quads.push_back({0, 1 + (2 * k + 2 * n - 1) % (2 * n), 1 + 2 * k, 2 + 2 * k});
  return of_quads(points, quads);
}

TEST(RegularityMeasures, AGridHasNone) { expect_regularity(quad_grid(5, 4), 0, 0, 0, {}); }

TEST(RegularityMeasures, OneVertexOfATriangleOrAPentagonIsNecessary) {
  expect_regularity(star(3), 1, 0, 1, {});
  expect_regularity(star(5), 1, 0, 1, {});
}

TEST(RegularityMeasures, ARotatedEdgeOfAGridIsTwoPairs) {
  Mesh mesh = quad_grid(6, 5);
  // The edge between these two, which loses its ends to (4, 2) and (2, 3).
  const auto at = [](int i, int j) { return 7 * j + i; };
  mesh.quads[6 * 2 + 2] = {at(2, 2), at(3, 2), at(4, 2), at(2, 3)};
  mesh.quads[6 * 2 + 3] = {at(4, 2), at(4, 3), at(3, 3), at(2, 3)};
  expect_regularity(mesh, 0, 4, 0, {{{1, 1}, 2}});
  std::set<std::pair<int, int>> pairs;
  for (const IrregularPair& pair : pair_irregular(mesh, sorted_half_edges(mesh)).pairs)
    pairs.insert({pair.few, pair.many});
  EXPECT_EQ(pairs, (std::set{std::pair(at(3, 2), at(4, 2)), std::pair(at(3, 3), at(2, 3))}));
}

TEST(RegularityMeasures, IrregularVerticesOnLinesAreToldApart) {
  Mesh mesh = star(5);
  EXPECT_EQ(evaluate_metrics(mesh, nullptr).values.at("n_irregular_on_curves"), 0);
  mesh.lines = {{1, 0}, {0, 3}};
  mesh.line_curve = {0, 0};
  mesh.curves = {{1, {}}};
  EXPECT_EQ(evaluate_metrics(mesh, nullptr).values.at("n_irregular"), 1);
  EXPECT_EQ(evaluate_metrics(mesh, nullptr).values.at("n_irregular_on_curves"), 1);
}

TEST(RegularityMeasures, AVertexOfSixIsInTwoPairs) {
  Mesh mesh = quad_grid(6, 6);
  // The quad from (2, 2) to (3, 3) is gone, and with it (3, 3).
  mesh.quads.erase(mesh.quads.begin() + 6 * 2 + 2);
  mesh.quad_region.pop_back();
  for (auto& quad : mesh.quads) std::ranges::replace(quad, 7 * 3 + 3, 7 * 2 + 2);
  expect_regularity(mesh, 0, 4, 0, {{{1, 1}, 2}});
}

/// A square whose sides have so many edges, with one vertex of three quads and one of five.
Mesh filled_square(const std::array<int, 4>& edges) {
  const std::array<Vec2, 4> corner = {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Outline outline;
  for (std::size_t i = 0; i < 4; ++i)
    for (int k = 0; k < edges[i]; ++k) {
      outline.places.push_back(corner[i] + (1.0 * k / edges[i]) * (corner[(i + 1) % 4] - corner[i]));
      outline.delta.push_back(1.0 / edges[i]);
      outline.turn.push_back(k == 0 ? 1 : 0);
    }
  const auto pattern = best_pattern(outline, 2);
  const PatternMesh fill = mesh_pattern(outline, *pattern);
  std::vector<Vec3> points;
  for (const Vec2& p : outline.places) points.push_back({p.x, p.y, 0});
  for (const Vec2& p : fill.inside) points.push_back({p.x, p.y, 0});
  return of_quads(points, fill.quads);
}

TEST(RegularityMeasures, APairEndsTheRowsThatOppositeSidesDifferBy) {
  for (const auto& edges :
       {std::array{10, 9, 8, 9}, {9, 9, 10, 10}, {12, 12, 9, 11}, {14, 8, 10, 8}, {13, 9, 9, 11}}) {
    const int rows = std::abs(edges[0] - edges[2]), columns = std::abs(edges[1] - edges[3]);
    expect_regularity(filled_square(edges), 0, 2, 0,
                      {{{std::max(rows, columns), std::min(rows, columns)}, 1}});
  }
}

/// A ring, inside of n edges and outside of two more; `rows` rows of quads, the last of which has them all.
Mesh ring(int n, int rows) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> quads;
  const auto add = [&](double radius, double t) {
    points.push_back(
        {radius * std::cos(2 * std::numbers::pi * t), radius * std::sin(2 * std::numbers::pi * t), 0});
    return static_cast<int>(points.size()) - 1;
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < n; ++i) add(1 + 0.3 * j, 1.0 * i / n);
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n;
      quads.push_back({n * j + i, n * j + n + i, n * j + n + next, n * j + next});
    }
  const int last = n * (rows - 1), outer = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) add(1 + 0.3 * rows, 1.0 * i / n);
  for (int i = 1; i < n; ++i) quads.push_back({last + i, outer + i, outer + (i + 1) % n, last + (i + 1) % n});
  // From the first edge to three.
  const double middle = 1 + 0.3 * (rows - 0.5);
  const int a = add(middle, 1 / (3.0 * n)), b = add(middle, 2 / (3.0 * n));
  const int c = add(1 + 0.3 * rows, 1 / (3.0 * n)), d = add(1 + 0.3 * rows, 2 / (3.0 * n));
  for (const auto& quad :
       {std::array{last, a, b, last + 1}, {last, outer, c, a}, {a, c, d, b}, {b, d, outer + 1, last + 1}})
    quads.push_back(quad);
  return of_quads(points, quads);
}

TEST(RegularityMeasures, ARingsCirclesOfDifferentCountsNeedPairs) {
  expect_regularity(ring(24, 3), 0, 4, 0, {{{1, 1}, 2}});
  // The vertices of too many quads lie on the inner circle.
  const Mesh flat = ring(24, 1);
  expect_regularity(flat, 0, 4, 0, {{{1, 1}, 2}});
  EXPECT_EQ(evaluate_metrics(flat, nullptr).values.at("n_irregular"), 2);
}

/// The surface of a cube of n^2 quads a side, a region each.
Mesh cube_surface(int n) {
  std::map<std::array<int, 3>, int> known;
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> quads;
  std::vector<int> region;
  for (int side = 0; side < 6; ++side)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto vertex = [&](int u, int v) {
          std::array<int, 3> x;
          x[side % 3] = side < 3 ? 0 : n;
          x[(side + 1) % 3] = side < 3 ? v : u;
          x[(side + 2) % 3] = side < 3 ? u : v;
          const auto [at, is_new] = known.try_emplace(x, static_cast<int>(points.size()));
          if (is_new) points.push_back({1.0 * x[0], 1.0 * x[1], 1.0 * x[2]});
          return at->second;
        };
        quads.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        region.push_back(side);
      }
  Mesh mesh = of_quads(points, quads);
  mesh.quad_region = region;
  mesh.regions.assign(6, {1, {}});
  return mesh;
}

TEST(RegularityMeasures, EightVerticesOfACubeAreNecessary) {
  Mesh mesh = cube_surface(3);
  expect_regularity(mesh, 8, 0, 0, {});  // corners of its six grids
  std::ranges::fill(mesh.quad_region, 0);
  expect_regularity(mesh, 8, 0, 8, {});  // as of a sphere
}

TEST(RegularityMeasures, ACurveThroughARegionCutsIt) {
  Mesh mesh = quad_grid(4, 4);
  mesh.curves.push_back({5, {"crack"}});
  for (int j = 0; j < 2; ++j) {
    mesh.lines.push_back({5 * j + 2, 5 * j + 7});
    mesh.line_curve.push_back(4);
  }
  expect_regularity(mesh, 0, 0, 0, {});
}

TEST(RegularityMeasures, IsNotDefinedWithTriangles) {
  Mesh mesh = quad_grid(2, 2);
  mesh.triangles = {{0, 1, 4}};
  EXPECT_FALSE(evaluate_metrics(mesh, nullptr).pairs);
  EXPECT_TRUE(std::isnan(evaluate_metrics(mesh, nullptr).values.at("n_necessary")));
}

}  // namespace
}  // namespace delquad
