// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/segment.h"
#include "geometry/surface/cut_planner.h"
#include "geometry/surface/laplacian.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

Chart one_chart(const SurfaceModel& model) {
  return extract_charts(model.fine, std::vector<char>(model.fine.triangles.size(), 1))[0];
}

std::vector<double> heights(const Chart& chart) {
  std::vector<double> u;
  for (const Vec3& p : chart.points) u.push_back(p.z);
  return u;
}

/// Triangles of the wanted part that are reached from its first one across sides.
std::size_t reached(const Chart& chart, const std::vector<char>& parts, char part) {
  const auto first = std::ranges::find(parts, part) - parts.begin();
  std::vector<char> seen(parts.size(), 0);
  std::vector<int> stack = {static_cast<int>(first)};
  seen[first] = 1;
  std::size_t n = 0;
  while (!stack.empty()) {
    const int t = stack.back();
    stack.pop_back();
    ++n;
    for (const int u : chart.neighbours[t])
      if (u >= 0 && !seen[u] && parts[u] == part) {
        seen[u] = 1;
        stack.push_back(u);
      }
  }
  return n;
}

TEST(Parting, BothPartsHangTogether) {
  for (const SurfaceModel& model : {cylinder(24, 10, 1, 2), grid_surface({9, 9}, [](double u, double v) {
                                      return Vec3{u, v, u * v};
                                    })}) {
    const Chart chart = one_chart(model);
    const std::vector<char> parts = plan_split(chart);
    ASSERT_EQ(parts.size(), chart.triangles.size());
    const auto first = static_cast<std::size_t>(std::ranges::count(parts, 0)), second = parts.size() - first;
    EXPECT_EQ(reached(chart, parts, 0), first);
    EXPECT_EQ(reached(chart, parts, 1), second);
    EXPECT_GT(3 * std::min(first, second), parts.size() / 2);
  }
}

TEST(LevelCurves, CirclesOfACylinder) {
  const Chart chart = one_chart(cylinder(24, 10, 1, 2));
  const auto curves = level_curves(chart, heights(chart), 0.9);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_TRUE(curves[0].path.closed);
  EXPECT_NEAR(curves[0].path.length, 2 * std::numbers::pi, 0.02);
  EXPECT_EQ(curves[0].crossed.size(), 48u);  // each edge between rows 4 and 5
}

TEST(LevelCurves, OpenPiecesEndOnTheBoundary) {
  const Chart chart = one_chart(grid_surface({9, 9}, [](double u, double v) {
    return Vec3{u, v, (2 * u - 1) * (2 * u - 1)};
  }));
  const auto curves = level_curves(chart, heights(chart), 0.3);
  ASSERT_EQ(curves.size(), 2u);
  for (const LevelCurve& c : curves) {
    EXPECT_FALSE(c.path.closed);
    for (const EdgePoint& end : {c.path.points.front(), c.path.points.back()})
      EXPECT_LT(end.a, chart.n_boundary);
  }
}

TEST(Descent, FollowsARuling) {
  const Chart chart = one_chart(cylinder(24, 10, 1, 2));
  std::vector<char> target(chart.points.size(), 0);
  int start = -1;
  for (int v = 0; v < chart.n_boundary; ++v) {
    target[v] = chart.points[v].z < 1;
    if (chart.points[v].z > 1) start = v;
  }
  const auto path = descend(chart, triangles_around(chart), heights(chart), start, target);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->length, 2, 1e-9);
  EXPECT_TRUE(target[path->points.back().a]);
}

TEST(Descent, StopsInAMinimumElsewhere) {
  const Chart chart = one_chart(grid_surface({9, 9}, [](double u, double v) {
    return Vec3{u, v, std::hypot(u - 0.5, v - 0.5)};
  }));
  EXPECT_FALSE(
      descend(chart, triangles_around(chart), heights(chart), 0, std::vector<char>(chart.points.size(), 0)));
}

TEST(CutPlanner, SeamBeginsAtACorner) {
  const SurfaceModel model = cylinder(24, 10, 1, 2);
  const Chart chart = one_chart(model);
  std::vector<CutEnd> ends(model.fine.points.size(), CutEnd::kAnywhere);
  const int corner = model.fine.lines[7][0];
  ends[corner] = CutEnd::kCorner;
  const auto seam = plan_seam(chart, ends);
  ASSERT_TRUE(seam);
  EXPECT_NEAR(seam->length, 2, 1e-9);
  EXPECT_EQ(chart.fine_node[seam->points.front().a], corner);
}

TEST(CutPlanner, SeamKeepsAwayFromPointsInside) {
  SurfaceModel model = cylinder(24, 10, 1, 2);
  std::vector<CutEnd> ends(model.fine.points.size(), CutEnd::kAnywhere);
  const int corner = model.fine.lines[7][0];
  ends[corner] = CutEnd::kCorner;
  const auto at = [&](int v) -> Vec3& { return model.fine.points[v]; };
  int inside = 0;  // on the ruling of the corner
  while (norm(Vec3{at(inside).x - at(corner).x, at(inside).y - at(corner).y, at(inside).z - 1}) > 1e-9)
    ++inside;
  ends[inside] = CutEnd::kCorner;
  const auto distance = [&](int v) {
    const Chart chart = one_chart(model);
    const auto seam = plan_seam(chart, ends);
    double least = 9;
    for (std::size_t i = 1; i < seam->points.size(); ++i)
      least = std::min(least, distance_to_segment(at(v), position(chart, seam->points[i - 1]),
                                                  position(chart, seam->points[i])));
    return least;
  };
  EXPECT_LT(distance(corner), 1e-12);
  EXPECT_LT(distance(inside), 1e-12);
  at(inside) = Motion{{}, 0.05}(at(inside));
  EXPECT_GT(distance(inside), 0.06);
}

TEST(CutPlanner, TipsAreFoundAndReached) {
  const SurfaceModel model = cone(24, 12, 0.6);
  const Chart chart = one_chart(model);
  const std::vector<int> tips = sharp_tips(chart);
  ASSERT_EQ(tips.size(), 1u);
  EXPECT_EQ(chart.points[tips[0]], (Vec3{0, 0, 0}));
  const auto cut =
      plan_tip_cut(chart, tips[0], std::vector<CutEnd>(model.fine.points.size(), CutEnd::kAnywhere));
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->length, 1, 5e-3);  // between two rulings the facets are nearer
  EXPECT_TRUE(sharp_tips(one_chart(round_sphere(6))).empty());
}

TEST(CutPlanner, DivisionsAreShort) {
  // A dumb-bell is divided at its neck.
  const SurfaceModel bell = grid_surface({32, 60, true}, [](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, z = 6 * v - 3,
                 r = 0.3 + 1.5 * std::pow(std::sin(z * std::numbers::pi / 3), 2);
    return Vec3{r * std::cos(phi), r * std::sin(phi), z};
  });
  const auto neck = plan_division(one_chart(bell));
  ASSERT_TRUE(neck);
  EXPECT_TRUE(neck->closed);
  EXPECT_LT(neck->length, 1.2 * 2 * std::numbers::pi * 0.3);
  // A handle is opened by a loop around the tube, which separates nothing.
  const auto loop = plan_division(one_chart(torus(60, 24, 3, 1)));
  ASSERT_TRUE(loop);
  EXPECT_NEAR(loop->length, 2 * std::numbers::pi, 0.3);
}

}  // namespace
}  // namespace delquad
