// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>

#include "metrics/metrics.h"
#include "metrics/size_efficiency.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kQuadrature = 1e-3;  // relative, what the integral promises
constexpr double kSizeRounding = 1e-12;

struct SizeBy final : SizeField {
  explicit SizeBy(std::function<double(const Vec3&)> f) : delta(std::move(f)) {}
  double at(const Vec3& x, int&) const override {
    ++evaluations;
    return delta(x);
  }
  std::function<double(const Vec3&)> delta;
  mutable std::atomic<long long> evaluations = 0;  ///< by all threads
};

TEST(AdimensionalLength, IsLengthOverSizeWhereSizeIsConstant) {
  const SizeBy size([](const Vec3&) { return 0.25; });
  EXPECT_NEAR(adimensional_length({1, 2, 3}, {3, 3, 5}, size), 12, kSizeRounding);
  EXPECT_EQ(adimensional_length({1, 2, 3}, {1, 2, 3}, size), 0);
}

TEST(AdimensionalLength, MatchesTheLogarithmForLinearSize) {
  // Along the segment delta = s + (g - s) t, so that l = |b - a| log(g / s) / (g - s).
  for (const double ratio : {1.01, 1.5, 4.0, 100.0, 1e6}) {
    const SizeBy size([ratio](const Vec3& x) { return 1 + (ratio - 1) * x.x; });
    const double exact = std::log(ratio) / (ratio - 1);
    EXPECT_NEAR(adimensional_length({0, 7, 0}, {1, 7, 0}, size), exact, kQuadrature * exact) << ratio;
    EXPECT_NEAR(adimensional_length({1, 7, 0}, {0, 7, 0}, size), exact, kQuadrature * exact) << ratio;
  }
}

TEST(AdimensionalLength, SeesAPeakInsideTheEdge) {
  // delta = w + |x - c|: l = log((w + c) / w) + log((w + 1 - c) / w); 1/delta at both ends is far below the
  // mean.
  for (const double c : {0.5, 0.3, 0.77}) {
    const double w = 1e-3;
    const SizeBy size([=](const Vec3& x) { return w + std::abs(x.x - c); });
    const double exact = std::log((w + c) / w) + std::log((w + 1 - c) / w);
    EXPECT_NEAR(adimensional_length({0, 0, 0}, {1, 0, 0}, size), exact, kQuadrature * exact) << c;
  }
}

TEST(AdimensionalLength, SeesASizeThatIsTheSameAtTheEndsAndTheMiddle) {
  const SizeBy size([](const Vec3& x) { return 1 / (1.5 - std::cos(4 * 3.14159265358979 * x.x)); });
  EXPECT_NEAR(adimensional_length({0, 0, 0}, {1, 0, 0}, size), 1.5, 1.5 * kQuadrature);
}

TEST(AdimensionalLength, EndsAtJumps) {
  const SizeBy size([](const Vec3& x) { return x.x < 1.0 / 3 ? 1e-4 : 1; });
  const double exact = 1e4 / 3 + 2.0 / 3;
  EXPECT_NEAR(adimensional_length({0, 0, 0}, {1, 0, 0}, size), exact, kQuadrature * exact);
  EXPECT_LT(size.evaluations, 200);
}

// As of two sheets in one place: which is nearer, rounding decides.
TEST(AdimensionalLength, EndsWhereSizesJumpEverywhere) {
  const SizeBy size([](const Vec3& x) { return std::sin(1e9 * x.x) < 0 ? 0.5 : 1.0; });
  const double length = adimensional_length({0, 0, 0}, {1, 0, 0}, size);
  EXPECT_NEAR(length, 1.5, 0.15);  // half of each; the mean of 256 values is within 2 %, five times that
  EXPECT_LT(size.evaluations, 1000);
}

double tau(const Mesh& mesh, const SizeField& size) { return evaluate_metrics(mesh, &size).values.at("tau"); }

TEST(Tau, CountsEachEdgeOnceWithItsOwnLength) {
  // Two cells of 1 x 1/2: 4 edges of length 1 and 3 of length 1/2.
  const Mesh mesh = quad_grid(2, 1, 2, 0.5);
  const SizeBy one([](const Vec3&) { return 1.0; }), half([](const Vec3&) { return 0.5; });
  EXPECT_NEAR(tau(mesh, one), 100 * std::exp(3 * (0.5 - 1) / 7), kSizeRounding * 100);
  EXPECT_NEAR(tau(mesh, half), 100 * std::exp(4 * (1 / 2.0 - 1) / 7), kSizeRounding * 100);
}

TEST(Tau, IsHundredOnlyWhereEveryEdgeFits) {
  const SizeBy fitting([](const Vec3&) { return 0.1; }), other([](const Vec3&) { return 0.1001; });
  EXPECT_NEAR(tau(quad_grid(10, 10), fitting), 100, kSizeRounding * 100);
  EXPECT_LT(tau(quad_grid(10, 10), other), 99.95);
  EXPECT_LT(tau(triangle_grid(10, 10), fitting), 95) << "diagonals are too long";
}

TEST(Tau, IsUndefinedWithoutSizeOrEdges) {
  const SizeBy size([](const Vec3&) { return 0.1; });
  EXPECT_TRUE(std::isnan(evaluate_metrics(quad_grid(2, 2), nullptr).values.at("tau")));
  EXPECT_TRUE(std::isnan(tau(testing_support::grid_outline(2, 2, 1, 1), size)));
}

TEST(Tau, NeedsFewEvaluationsWhereSizeVariesLittle) {
  const Mesh mesh = quad_grid(30, 30);
  const SizeBy size([](const Vec3& x) { return 0.03 * (1 + x.x); });
  tau(mesh, size);
  const long long n_edges = 2 * 30 * 31, n_vertices = 31 * 31;
  EXPECT_EQ(size.evaluations, 3 * n_edges + n_vertices);
}

}  // namespace
}  // namespace delquad
