// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_adaptation.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

constexpr int kMostSweeps = AdaptationOptions{}.max_sweeps;

/// The mesh is a triangulation of the patch with the boundary that was given.
void expect_sound(const TriPatch& tri, const PatchBoundary& boundary) {
  const auto wrong = check_invariants(tri);
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  ASSERT_EQ(tri.n_boundary, static_cast<int>(boundary.points.size()));
  EXPECT_TRUE(std::equal(boundary.points.begin(), boundary.points.end(), tri.points.begin()));
  std::set<std::array<int, 2>> outline, expected(boundary.edges.begin(), boundary.edges.end());
  std::vector<char> used(tri.points.size(), 0);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto& v = tri.triangles[t];
      used[v[k]] = 1;
      if (tri.neighbours[t][k] < 0) outline.insert({v[(k + 1) % 3], v[(k + 2) % 3]});
    }
  EXPECT_EQ(outline, expected);
  EXPECT_EQ(std::ranges::count(used, 0), 0);
}

/// Share of the inner edges whose length in the L-infinity norm lies between 1/sqrt 2 and sqrt 2.
double unit_share(const TriPatch& tri, double theta, double delta) {
  double edges = 0, good = 0;
  const Vec2 e = {std::cos(theta), std::sin(theta)};
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] < static_cast<int>(t)) continue;
      const auto& v = tri.triangles[t];
      const Vec2 d = (1 / delta) * (tri.points[v[(k + 1) % 3]] - tri.points[v[(k + 2) % 3]]);
      const double l = std::max(std::abs(dot(e, d)), std::abs(cross(e, d)));
      ++edges;
      good += l > std::numbers::sqrt2 / 2 && l < std::numbers::sqrt2;
    }
  return good / edges;
}

TEST(LinfAdaptation, ALatticeComesBackFromItsShakenPoints) {
  constexpr int n = 12;
  constexpr double h = 1.0 / n, theta = 0.4;
  const PatchBoundary boundary = shapes::rectangle(1, 1, n, n, theta);
  std::mt19937_64 random(5);
  const auto turned = [&](double x, double y) {
    return Vec2{std::cos(theta) * x - std::sin(theta) * y, std::sin(theta) * x + std::cos(theta) * y};
  };
  std::vector<Vec2> inner;
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      inner.push_back(turned(h * (i + 0.3 * (shapes::uniform(random) - 0.5)),
                             h * (j + 0.3 * (shapes::uniform(random) - 0.5))));
  const TriPatch tri =
      adapt_linf(constrained_delaunay(boundary, inner), FunctionCross(theta), FunctionSize(h));
  expect_sound(tri, boundary);
  ASSERT_EQ(tri.points.size(), static_cast<std::size_t>((n + 1) * (n + 1)));
  for (const Vec2 p : tri.points) {
    const double i = (std::cos(theta) * p.x + std::sin(theta) * p.y) / h;
    const double j = (std::cos(theta) * p.y - std::sin(theta) * p.x) / h;
    EXPECT_NEAR(i, std::round(i), 0.01);
    EXPECT_NEAR(j, std::round(j), 0.01);
  }
}

/// Far too coarse and far too fine beginnings end at the size.
TEST(LinfAdaptation, SplitsAndCollapsesToTheSize) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 16, 16);
  for (const double start : {0.0, 0.02}) {
    const TriPatch initial =
        start == 0 ? constrained_delaunay(boundary)
                   : mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0.0), FunctionSize(start));
    AdaptationSummary s;
    const TriPatch tri = adapt_linf(initial, FunctionCross(0.0), FunctionSize(1.0 / 16), {}, &s);
    expect_sound(tri, boundary);
    EXPECT_NEAR(static_cast<double>(tri.points.size()), 17 * 17, 60) << start;
    EXPECT_GT(unit_share(tri, 0, 1.0 / 16), 0.95) << start;
    EXPECT_GT(start == 0 ? s.splits : s.collapses, 100);
    EXPECT_LE(s.sweeps, kMostSweeps);
  }
}

TEST(LinfAdaptation, RandomDomainsStaySound) {
  const FunctionCross field([](Vec2 u) { return u.x - 2 * u.y; });
  for (const double growth : {0.0, 0.4}) {
    const FunctionSize size([&](Vec2 u) { return growth == 0 ? 0.06 : 0.003 + growth * norm(u); });
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(seed);
      const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
      const TriPatch initial = mesh_frontal(boundary, *make_l2_frontal(), field, size);
      AdaptationSummary s;
      const TriPatch tri = adapt_linf(initial, field, size, {}, &s);
      expect_sound(tri, boundary);
      EXPECT_LE(s.sweeps, kMostSweeps);
      EXPECT_EQ(static_cast<long long>(tri.points.size()),
                static_cast<long long>(initial.points.size()) + s.splits - s.collapses);
    }
  }
}

TEST(LinfAdaptation, SharpCornersAndSlivers) {
  for (const double height : {0.3, 0.03, 0.003}) {
    const PatchBoundary boundary = shapes::polygon({{0, 0}, {1, -height}, {1, height}}, 6);
    expect_sound(adapt_linf(constrained_delaunay(boundary), FunctionCross(0.3), FunctionSize(0.02)),
                 boundary);
  }
}

TEST(LinfAdaptation, StopsAtTheMostPoints) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 4, 4);
  AdaptationOptions options;
  options.max_points = 500;
  const TriPatch tri =
      adapt_linf(constrained_delaunay(boundary), FunctionCross(0.0), FunctionSize(1e-3), options);
  expect_sound(tri, boundary);
  EXPECT_LE(tri.points.size(), 500u);
}

}  // namespace
}  // namespace delquad
