// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/chart.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

std::vector<Chart> all_charts(const SurfaceModel& model) {
  return extract_charts(model.fine, std::vector<char>(model.fine.triangles.size(), 1));
}

TEST(Chart, CountsLoopsAndHandles) {
  struct Case {
    SurfaceModel model;
    std::size_t loops;
    int handles;
  };
  const Case cases[] = {{bump(6, 1), 1, 0},      {cylinder(8, 4, 1, 1), 2, 0}, {cone(8, 4, 0.5), 1, 0},
                        {round_sphere(3), 0, 0}, {torus(12, 6, 3, 1), 0, 1},   {tee(2), 3, 0},
                        {double_torus(2), 0, 2}};
  for (const Case& c : cases) {
    const std::vector<Chart> charts = all_charts(c.model);
    ASSERT_EQ(charts.size(), 1u);
    EXPECT_EQ(charts[0].loops.size(), c.loops);
    EXPECT_EQ(genus(charts[0]), c.handles);
  }
}

TEST(Chart, DefectsSumToTheEulerCharacteristic) {
  const auto sum = [](const SurfaceModel& m) {
    const std::vector<double> defects = angle_defects(all_charts(m)[0]);
    return std::accumulate(defects.begin(), defects.end(), 0.0);
  };
  EXPECT_NEAR(sum(bump(6, 1)), 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(sum(cylinder(8, 4, 1, 1)), 0, 1e-9);
  EXPECT_NEAR(sum(round_sphere(3)), 4 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(sum(double_torus(2)), -4 * std::numbers::pi, 1e-9);
}

// A line from the middle of a square to its side: the points on it are there twice, its inner end once.
TEST(Chart, OpensAlongLinesInside) {
  SurfaceModel model = grid_surface({4, 4}, [](double u, double v) { return Vec3{u, v, 0}; });
  Mesh& fine = model.fine;
  const auto node = [&](double x, double y) {
    return static_cast<int>(std::ranges::find(fine.points, Vec3{x, y, 0}) - fine.points.begin());
  };
  fine.curves.push_back({2, {}});
  for (double y : {0.0, 0.25}) {
    fine.lines.push_back({node(0.5, y), node(0.5, y + 0.25)});
    fine.line_curve.push_back(1);
  }
  const std::vector<Chart> charts = all_charts(model);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0].loops.size(), 1u);
  EXPECT_EQ(charts[0].n_boundary, 16 + 4);
  EXPECT_EQ(std::ranges::count(charts[0].fine_node, node(0.5, 0)), 2);
  EXPECT_EQ(std::ranges::count(charts[0].fine_node, node(0.5, 0.25)), 2);
  EXPECT_EQ(std::ranges::count(charts[0].fine_node, node(0.5, 0.5)), 1);
}

// Two triangles of one face that meet in a point are two charts.
TEST(Chart, PartsThatTouchInAPointAreApart) {
  SurfaceModel model;
  model.fine.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  model.fine.triangles = {{0, 1, 2}, {0, 3, 4}};
  model.fine.triangle_region = {0, 0};
  model.fine.regions = {{1, {}}};
  model.fine.lines = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  model.fine.line_curve.assign(6, 0);
  model.fine.curves = {{1, {}}};
  EXPECT_EQ(all_charts(model).size(), 2u);
}

TEST(Chart, RefusesSidesOnNoCurve) {
  SurfaceModel model = bump(3, 1);
  model.fine.lines.pop_back();
  model.fine.line_curve.pop_back();
  EXPECT_THROW(all_charts(model), InputError);
  SurfaceModel turned = bump(3, 1);
  std::swap(turned.fine.triangles[4][0], turned.fine.triangles[4][1]);
  EXPECT_THROW(all_charts(turned), InputError);
}

}  // namespace
}  // namespace delquad
