// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/arc_measure.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

constexpr double kMost = 1e6;

/// delta = a + b |x - x0| along a segment of the x axis.
TestSize graded(double a, double b, double x0) {
  return [=](const Vec3& p) { return a + b * std::abs(p.x - x0); };
}
std::vector<Vec2> nodes_on(const Curve& curve, const ArcMeasure& measure, int n) {
  std::vector<Vec2> nodes;
  for (const double t : measure.interior_nodes(n)) nodes.push_back(curve.point(t));
  return nodes;
}
double graded_integral(double a, double b, double length) { return std::log(1 + b * length / a) / b; }

TEST(ArcMeasure, IsExactOnUniformSegments) {
  const auto curve = make_segment({0, 0}, {1, 0});
  const TestSize size = constant(0.05);
  const ArcMeasure measure(*curve, 0, 1, size, "curve", kMost);
  EXPECT_DOUBLE_EQ(measure.integral(), 20);
  const std::vector<Vec2> nodes = nodes_on(*curve, measure, 20);
  ASSERT_EQ(nodes.size(), 19u);
  for (int k = 1; k < 20; ++k) {
    EXPECT_NEAR(nodes[static_cast<std::size_t>(k) - 1].x, k / 20.0, 1e-15);
    EXPECT_EQ(nodes[static_cast<std::size_t>(k) - 1].y, 0);
  }
}

TEST(ArcMeasure, DoesNotAddUpRoundingErrors) {
  constexpr int kEdges = 99991;
  const auto curve = make_segment({0, 0}, {1, 0});
  const TestSize size = constant(1.0 / kEdges);
  const std::vector<Vec2> nodes = nodes_on(*curve, ArcMeasure(*curve, 0, 1, size, "curve", kMost), kEdges);
  for (std::size_t k = 1; k < kEdges; ++k)
    ASSERT_NEAR(nodes[k - 1].x, static_cast<double>(k) / kEdges, 2e-15) << k;
}

TEST(ArcMeasure, MeasuresCurvesAgainstClosedForms) {
  const TestSize size = constant(0.1);
  const auto circle = make_circle({3, 4}, 2);
  EXPECT_NEAR(ArcMeasure(*circle, 0, 1, size, "", kMost).integral() / (40 * std::numbers::pi), 1, 1e-6);
  // The parabola y = x^2 over [0, 1].
  const double parabola = std::sqrt(5.0) / 2 + std::asinh(2.0) / 4;
  const auto regular = make_expression_curve("t", "t^2", 0, 1);
  EXPECT_NEAR(ArcMeasure(*regular, 0, 1, size, "", kMost).integral() / (10 * parabola), 1, 1e-6);
  // The same with a parametrization that stands still at the start.
  const auto slow = make_expression_curve("t^3", "t^6", 0, 1);
  EXPECT_NEAR(ArcMeasure(*slow, 0, 1, size, "", kMost).integral() / (10 * parabola), 1, 1e-6);
}

class StrongGrading : public ::testing::TestWithParam<double> {};

TEST_P(StrongGrading, IsIntegratedAndSplitEvenly) {
  const double smallest = GetParam(), slope = 0.2;
  const TestSize size = graded(smallest, slope, 0.3);
  const auto curve = make_segment({0, 0}, {1, 0});
  const ArcMeasure measure(*curve, 0, 1, size, "curve", kMost);
  const double left = graded_integral(smallest, slope, 0.3), right = graded_integral(smallest, slope, 0.7);
  EXPECT_NEAR(measure.integral() / (left + right), 1, 1e-6);

  const int n = static_cast<int>(std::lround(measure.integral()));
  const std::vector<Vec2> nodes = nodes_on(*curve, measure, n);
  for (int k = 1; k < n; ++k) {
    const double x = nodes[static_cast<std::size_t>(k) - 1].x;
    const double here = x < 0.3 ? left - graded_integral(smallest, slope, 0.3 - x)
                                : left + graded_integral(smallest, slope, x - 0.3);
    EXPECT_NEAR(here, (left + right) * k / n, 1e-6 * (left + right)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(SmallestSize, StrongGrading, ::testing::Values(0.1, 1e-3, 1e-6, 1e-9));

TEST(ArcMeasure, FollowsAJumpOfTheSize) {
  const TestSize size = [](const Vec3& p) { return p.x < 1 / 3.0 ? 0.001 : 0.1; };
  const auto curve = make_segment({0, 0}, {1, 0});
  const ArcMeasure measure(*curve, 0, 1, size, "curve", kMost);
  const double exact = 1000 / 3.0 + 10 * 2 / 3.0;
  EXPECT_NEAR(measure.integral() / exact, 1, 1e-6);
  double last = 0;
  for (Vec2 p : nodes_on(*curve, measure, 340)) {
    EXPECT_GT(p.x, last);
    last = p.x;
  }
}

TEST(ArcMeasure, SeesANarrowDipOfTheSize) {
  // 300 times finer than the edges around it, and no wider than two of them.
  const TestSize size = [](const Vec3& p) {
    return 0.01 - 0.00997 * std::exp(-std::pow((p.x - 0.7177) / 0.01, 2));
  };
  const auto curve = make_segment({0, 0}, {1, 0});
  const double integral = ArcMeasure(*curve, 0, 1, size, "curve", kMost).integral();
  double brute = 0;
  constexpr int kSamples = 2000000;
  int hint = -1;
  for (int k = 0; k < kSamples; ++k) brute += 1 / (size.at({(k + 0.5) / kSamples, 0, 0}, hint) * kSamples);
  EXPECT_NEAR(integral / brute, 1, 1e-6);
}

TEST(ArcMeasure, IsTheSameBothWays) {
  const TestSize size = [](const Vec3& p) { return 0.01 + 0.3 * p.x * p.x + 0.1 * p.y * p.y; };
  const auto there = make_arc({0, 0}, 1, 0.1, 2), back = make_arc({0, 0}, 1, 2, 0.1);
  const ArcMeasure a(*there, 0, 1, size, "", kMost), b(*back, 0, 1, size, "", kMost);
  EXPECT_NEAR(a.integral(), b.integral(), 1e-12 * a.integral());
  const std::vector<Vec2> p = nodes_on(*there, a, 50), q = nodes_on(*back, b, 50);
  for (std::size_t i = 0; i < p.size(); ++i)
    EXPECT_LT(norm(p[i] - q[q.size() - 1 - i]), 1e-9);  // the rules' own error
}

TEST(ArcMeasure, DoesNotRefineBeyondWhatIsAllowed) {
  int calls = 0;
  const TestSize size = [&calls](const Vec3&) { return ++calls, 1e-15; };
  const auto curve = make_segment({0, 0}, {1, 0});
  EXPECT_NEAR(ArcMeasure(*curve, 0, 1, size, "curve", kMost).integral() / 1e15, 1, 1e-6);
  EXPECT_LT(calls, 1000);
}

TEST(ArcMeasure, NamesWhatCannotBeMeasured) {
  const auto segment = make_segment({0, 0}, {1, 0});
  const auto measure = [&](const Curve& curve, const TestSize& size) {
    return [&curve, size] { ArcMeasure(curve, 0, 1, size, "curve 'wing'", kMost); };
  };
  expect_input_error(measure(*segment, [](const Vec3& p) { return 0.5 - p.x; }),
                     {"size is 0", "(0.5, 0)", "'wing'"});
  expect_input_error(measure(*segment, constant(std::numeric_limits<double>::quiet_NaN())),
                     {"size is nan", "'wing'"});
  expect_input_error(measure(*segment, constant(std::numeric_limits<double>::infinity())), {"size is inf"});
  const auto pole = make_expression_curve("t", "1/t", -1, 1);
  expect_input_error(measure(*pole, constant(0.1)), {"'wing'", "(0, inf)", "finite"});
  const auto jump = make_expression_curve("t", "t < 0.4 ? 0 : 1", 0, 1);
  expect_input_error(measure(*jump, constant(0.01)), {"'wing' jumps", "(0.4"});
  const TestSize noise = [](const Vec3& p) { return 0.02 + 0.01 * std::sin(1e12 * p.x); };
  expect_input_error(measure(*segment, noise), {"too fast", "'wing'"});
}

}  // namespace
}  // namespace delquad
