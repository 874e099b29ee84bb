// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Rounding of a few operations on numbers near 1.
constexpr double kRounding = 1e-15;

void expect_near(Vec2 a, Vec2 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(Curves, SegmentEndsExactly) {
  const Vec2 a{0.1, 0.7}, b{1.0 / 3, -0.2};
  const auto curve = make_segment(a, b);
  EXPECT_EQ(curve->point(0), a);
  EXPECT_EQ(curve->point(1), b);
  expect_near(curve->point(0.25), 0.75 * a + 0.25 * b, kRounding);
  EXPECT_TRUE(curve->fixed_parameters().empty());
}

TEST(Curves, SplineIsACircleToFourthOrder) {
  // Sixteen and 32 points of a circle: the error of a periodic cubic spline falls by 16 from the one to the
  // other.
  double off[2] = {};
  for (const int k : {0, 1}) {
    const int n = 16 << k;
    std::vector<Vec2> points;
    for (int i = 0; i <= n; ++i)
      points.push_back({std::cos(2 * kPi * (i % n) / n), std::sin(2 * kPi * (i % n) / n)});
    const auto curve = make_spline(points);
    EXPECT_TRUE(curve->fixed_parameters().empty());
    EXPECT_EQ(curve->point(0), points[0]);
    EXPECT_EQ(curve->point(1), points[0]);
    for (int i = 0; i < 1000; ++i) off[k] = std::max(off[k], std::abs(norm(curve->point(i / 1000.0)) - 1));
  }
  EXPECT_LT(off[0], 1e-3);
  EXPECT_NEAR(off[0] / off[1], 16, 2);
}

TEST(Curves, SplineBreaksAtCorners) {
  // A closed half disc that begins in the middle of its straight side: straight there, and smooth on the arc.
  std::vector<Vec2> points{{0, 0}, {0.5, 0}, {1, 0}};
  for (int i = 1; i < 12; ++i) points.push_back({std::cos(kPi * i / 12), std::sin(kPi * i / 12)});
  for (const double x : {-1.0, -0.5, 0.0}) points.push_back({x, 0});
  const auto curve = make_spline(points);
  const std::vector<double> corners = curve->fixed_parameters();
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_EQ(curve->point(0), (Vec2{1, 0}));
  EXPECT_EQ(curve->point(1), (Vec2{1, 0}));
  EXPECT_EQ(curve->point(corners[0]), (Vec2{-1, 0}));
  for (int i = 0; i <= 100; ++i) {
    EXPECT_EQ(curve->point(corners[0] + (1 - corners[0]) * i / 100).y, 0);
    EXPECT_NEAR(norm(curve->point(corners[0] * i / 100)), 1, 4e-3);  // natural ends are flat
  }
}

TEST(Curves, PolylineHasNodesAtItsCorners) {
  // Lengths from 1e-12 to 1: each edge keeps its own span of the parameter.
  const std::vector<Vec2> points{{0, 0},   {1, 0},   {1, 1e-12}, {1, 0.3},
                                 {0, 0.3}, {0, 0.1}, {0.5, 0.1}, {0, 0}};
  const auto curve = make_polyline(points);
  const std::vector<double> corners = curve->fixed_parameters();
  ASSERT_EQ(corners.size(), points.size() - 2);
  for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_EQ(curve->point(corners[i]), points[i + 1]);
  EXPECT_EQ(curve->point(0), points.front());
  EXPECT_EQ(curve->point(1), points.back());
  expect_near(curve->point(0.5 / 7), {0.5, 0}, kRounding);
}

TEST(Curves, ArcRunsEitherWay) {
  const auto there = make_arc({1, 2}, 3, 0.2, 1.5), back = make_arc({1, 2}, 3, 1.5, 0.2);
  EXPECT_EQ(there->point(0), back->point(1));
  EXPECT_EQ(there->point(1), back->point(0));
  expect_near(there->point(0.5), {1 + 3 * std::cos(0.85), 2 + 3 * std::sin(0.85)}, 4 * kRounding);
}

TEST(Curves, FullTurnsCloseBitForBit) {
  const auto circle = make_circle({0.3, -0.7}, 1.1);
  EXPECT_EQ(circle->point(0), circle->point(1));
  const auto turn = make_arc({0.3, -0.7}, 1.1, 2.5, 2.5 - 2 * kPi);
  EXPECT_EQ(turn->point(0), turn->point(1));
  expect_near(turn->point(0.25), {0.3 + 1.1 * std::cos(2.5 - kPi / 2), -0.7 + 1.1 * std::sin(2.5 - kPi / 2)},
              4 * kRounding);
}

TEST(Curves, ExpressionCurveFollowsItsFormulas) {
  const auto curve = make_expression_curve("t^2", "1 - t", 2, -1);
  EXPECT_EQ(curve->point(0), (Vec2{4, -1}));
  EXPECT_EQ(curve->point(1), (Vec2{1, 2}));
  expect_near(curve->point(0.5), {0.25, 0.5}, kRounding);
}

TEST(Curves, RejectCurvesWithoutLengthOrFiniteNumbers) {
  expect_input_error([] { make_segment({1, 2}, {1, 2}); }, {"no length", "(1, 2)"});
  expect_input_error([] { make_segment({1, kNan}, {1, 2}); }, {"start", "finite"});
  expect_input_error([] { make_polyline({{0, 0}}); }, {"1 points", "two"});
  expect_input_error(
      [] {
        make_polyline({{0, 0}, {1, 0}, {1, 0}});
      },
      {"zero-length", "points 2 and 3", "(1, 0)"});
  expect_input_error([] { make_polyline({{0, 0}, {1, kNan}}); }, {"point 2", "finite"});
  expect_input_error([] { make_circle({0, 0}, 0); }, {"radius is 0"});
  expect_input_error([] { make_circle({0, 0}, kNan); }, {"radius is nan"});
  expect_input_error([] { make_arc({0, 0}, 1, 0.5, 0.5); }, {"no length"});
  expect_input_error([] { make_arc({0, 0}, 1, 0, 7); }, {"one turn"});
  expect_input_error([] { make_expression_curve("t", "u", 0, 1); }, {"'u' is not known"});
  expect_input_error([] { make_expression_curve("t", "t", 1, 1); }, {"no length"});
}

}  // namespace
}  // namespace delquad
