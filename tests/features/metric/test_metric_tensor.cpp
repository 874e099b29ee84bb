// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

void expect_near(const Tensor2& a, const Tensor2& b, double relative) {
  const double size = std::abs(b.xx) + std::abs(b.yy);
  EXPECT_NEAR(a.xx, b.xx, relative * size);
  EXPECT_NEAR(a.xy, b.xy, relative * size);
  EXPECT_NEAR(a.yy, b.yy, relative * size);
}

TEST(MetricTensor, AxesComeBack) {
  for (const double theta : {-1.2, 0.0, 0.3, 1.5}) {
    const MetricAxes axes = axes_of(tensor_of({1e-4, 0.1, theta}));
    EXPECT_NEAR(axes.h1, 1e-4, 1e-13);
    EXPECT_NEAR(axes.h2, 0.1, 1e-7);
    EXPECT_NEAR(axes.theta, theta, 1e-9);
  }
}

TEST(MetricTensor, IntersectionOfRectanglesIsTheirCommonPart) {
  expect_near(intersection(tensor_of({1, 4, 0}), tensor_of({2, 3, 0})), tensor_of({1, 3, 0}), 1e-14);
}

// The unit circle of the intersection lies in both unit circles and touches each.
TEST(MetricTensor, IntersectionIsTheLargestInBoth) {
  const Tensor2 a = tensor_of({1, 10, 0.3}), b = tensor_of({2, 5, -0.9}), both = intersection(a, b);
  double least_a = std::numeric_limits<double>::infinity(), least_b = least_a, least = least_a;
  for (int k = 0; k < 3600; ++k) {
    const double theta = k * std::numbers::pi / 3600;
    const Vec2 d{std::cos(theta), std::sin(theta)};
    const double l = metric_length(d, both, both);
    least_a = std::min(least_a, l / metric_length(d, a, a));
    least_b = std::min(least_b, l / metric_length(d, b, b));
    least = std::min(least, l / std::max(metric_length(d, a, a), metric_length(d, b, b)));
  }
  EXPECT_GT(least, 1 - 1e-12);
  EXPECT_NEAR(least_a, 1, 1e-5);
  EXPECT_NEAR(least_b, 1, 1e-5);
}

TEST(MetricTensor, LogMeanHasGeometricLengths) {
  const std::array both{tensor_of({1, 100, 0.4}), tensor_of({4, 25, 0.4})};
  expect_near(log_mean(both, std::array{0.5, 0.5}), tensor_of({2, 50, 0.4}), 1e-12);
  // Turned by a quarter against each other they cancel.
  const std::array crossed{tensor_of({1, 100, 0}), tensor_of({1, 100, std::numbers::pi / 2})};
  expect_near(log_mean(crossed, std::array{0.5, 0.5}), tensor_of({10, 10, 0}), 1e-12);
}

// h = exp(k s) along a line: its length is the integral of exp(-k s).
TEST(MetricTensor, LengthIsThatOfExponentialSizes) {
  const double k = 1.7,
               length = metric_length({2, 0}, tensor_of({1, 1, 0}), tensor_of({std::exp(2 * k), 1, 0}));
  EXPECT_NEAR(length, (1 - std::exp(-2 * k)) / k, 1e-12);
  const double nearly = metric_length({1, 0}, tensor_of({1, 1, 0}), tensor_of({1 + 1e-9, 1, 0}));
  EXPECT_NEAR(nearly, 1, 1e-8);
}

TEST(MetricTensor, GrowsByTheFactorPerUnitLength) {
  const MetricAxes axes = axes_of(grown(tensor_of({1, 3, 0.2}), 2, std::exp(0.5)));
  EXPECT_NEAR(axes.h1, 2, 1e-12);
  EXPECT_NEAR(axes.h2, 6, 1e-12);
}

TEST(MetricTensor, LimitsHoldLengthsAndTheirRatio) {
  const MetricAxes between = axes_of(limited(tensor_of({1e-3, 7, 0.2}), {.min = 0.01, .max = 2}));
  EXPECT_NEAR(between.h1, 0.01, 1e-12);
  EXPECT_NEAR(between.h2, 2, 1e-12);
  const MetricAxes blunt = axes_of(limited(tensor_of({1e-3, 7, 0.2}), {.aspect = 50}));
  EXPECT_NEAR(blunt.h1, 1e-3, 1e-12);
  EXPECT_NEAR(blunt.h2, 0.05, 1e-9);
  EXPECT_NEAR(blunt.theta, 0.2, 1e-9);
}

TEST(MetricTensor, TellsWhatIsNoMetric) {
  EXPECT_TRUE(is_metric({2, 1, 1}));
  EXPECT_FALSE(is_metric({1, 1, 1}));
  EXPECT_FALSE(is_metric({1, 2, 1}));
  EXPECT_FALSE(is_metric({-1, 0, -1}));
  EXPECT_FALSE(is_metric({1, 0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(is_metric({std::numeric_limits<double>::infinity(), 0, 1}));
  EXPECT_FALSE(is_metric(tensor_of({1e-12, 1, 0.3})));
}

// |H| det^(-1/6) is of degree 2/3 in H, and blind to signs.
TEST(MetricTensor, OfAHessian) {
  const Tensor2 m = l2_metric({8, 0, -27});
  expect_near(m, {8 / std::pow(216, 1.0 / 6), 0, 27 / std::pow(216, 1.0 / 6)}, 1e-12);
  EXPECT_TRUE(is_metric(l2_metric({0, 0, 0})));
}

TEST(MetricTensor, FieldsOnAMesh) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_region = {0};
  mesh.regions.resize(1);
  const MetricFunction field =
      make_nodal_metric(mesh, {tensor_of({1, 2, 0}), tensor_of({4, 2, 0}), tensor_of({1, 2, 0})});
  const Vec2 at{0.5, 0.25};
  Tensor2 m;
  field({&at, 1}, {&m, 1});
  expect_near(m, tensor_of({2, 2, 0}), 1e-12);
  expect_input_error([&] { make_nodal_metric(mesh, {Tensor2{}}); }, {"3 points, but there are 1 values"});
  expect_input_error(
      [&] {
        make_nodal_metric(mesh, {{}, {}, {1, 3, 1}});
      },
      {"[1, 3, 1] (m11, m12, m22) at (0, 1)"});
}

}  // namespace
}  // namespace delquad
