// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/jacobian_bounds.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A straight quad's nodes, moved at random by up to `shift`.
std::vector<Vec3> random_element(int order, double shift, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> random(-shift, shift);
  std::vector<Vec3> nodes;
  for (int j = 0; j <= order; ++j)
    for (int i = 0; i <= order; ++i)
      nodes.push_back({1.0 * i / order + random(engine), 1.0 * j / order + random(engine), random(engine)});
  return nodes;
}

/// By Lagrange's polynomials and differences: nothing of what is tested.
Vec3 place(const std::vector<Vec3>& nodes, int order, double u, double v) {
  const auto weight = [&](int i, double t) {
    double w = 1;
    for (int k = 0; k <= order; ++k)
      if (k != i) w *= (t * order - k) / (i - k);
    return w;
  };
  Vec3 sum;
  for (int j = 0; j <= order; ++j)
    for (int i = 0; i <= order; ++i) sum = sum + weight(i, u) * weight(j, v) * nodes[j * (order + 1) + i];
  return sum;
}

double scaled_jacobian(const std::vector<Vec3>& nodes, int order, const Vec3& n, double u, double v) {
  constexpr double kStep = 1e-5;
  const Vec3 xu = place(nodes, order, u + kStep, v) - place(nodes, order, u - kStep, v);
  const Vec3 xv = place(nodes, order, u, v + kStep) - place(nodes, order, u, v - kStep);
  return dot(cross(xu, xv), n) / (norm(xu) * norm(xv));
}

double least_of_samples(const std::vector<Vec3>& nodes, int order) {
  constexpr int kSamples = 60;
  const Vec3 n = mean_normal(nodes, order);
  double least = 1;
  for (int j = 0; j <= kSamples; ++j)
    for (int i = 0; i <= kSamples; ++i)
      least = std::min(least, scaled_jacobian(nodes, order, n, 1.0 * i / kSamples, 1.0 * j / kSamples));
  return least;
}

TEST(JacobianBounds, HoldForRandomElements) {
  int positive = 0, others = 0;
  for (int order = 1; order <= kMostOrder; ++order)
    for (unsigned seed = 0; seed < 60; ++seed) {
      const std::vector<Vec3> nodes = random_element(order, 0.45 / (order * order), seed);
      const JacobianBounds bounds = jacobian_bounds(nodes, order);
      const double least = least_of_samples(nodes, order);
      EXPECT_LE(bounds.proven, bounds.found);
      EXPECT_LE(bounds.proven, least + 1e-6) << order << ", " << seed;
      if (least > 0.05) {
        EXPECT_GT(bounds.proven, 0.9 * least - 0.02) << order << ", " << seed;
        ++positive;
      }
      if (least < -1e-3) {
        EXPECT_FALSE(bounds.positive());
        ++others;
      }
    }
  EXPECT_GT(positive, 50);
  EXPECT_GT(others, 10);
}

TEST(JacobianBounds, OfAParallelogramIsTheSineOfItsAngle) {
  for (const double angle : {90.0, 60.0, 10.0, 0.01}) {
    const double a = angle * std::numbers::pi / 180;
    const std::vector<Vec3> nodes{
        {0, 0, 2}, {3, 0, 2}, {std::cos(a), std::sin(a), 2}, {3 + std::cos(a), std::sin(a), 2}};
    const JacobianBounds bounds = jacobian_bounds(nodes, 1);
    EXPECT_NEAR(bounds.proven, std::sin(a), 1e-9);
    EXPECT_NEAR(bounds.found, std::sin(a), 1e-9);
  }
}

TEST(JacobianBounds, KnowFlatAndFoldedElements) {
  EXPECT_FALSE(jacobian_bounds(std::vector<Vec3>(9), 2).positive());
  std::vector<Vec3> nodes = random_element(2, 0, 0);
  EXPECT_NEAR(jacobian_bounds(nodes, 2).proven, 1, 1e-9);
  nodes[1].y = 0.49;  // the first side reaches almost to the middle
  EXPECT_FALSE(jacobian_bounds(nodes, 2).positive());
  // Corners alone do not tell: here they are right angles.
  EXPECT_LT(jacobian_bounds(nodes, 2).found, 0.2);
}

/// The usual shape functions of eight nodes: nothing of what is tested.
Vec3 place_of_eight(const std::vector<Vec3>& nodes, double u, double v) {
  const double r = 2 * u - 1, s = 2 * v - 1;
  Vec3 sum;
  for (int k = 0; k < 9; ++k) {
    const double i = k % 3 - 1, j = k / 3 - 1;
    double weight = 0;
    if (i != 0 && j != 0) weight = 0.25 * (1 + r * i) * (1 + s * j) * (r * i + s * j - 1);
    if (i == 0 && j != 0) weight = 0.5 * (1 - r * r) * (1 + s * j);
    if (i != 0 && j == 0) weight = 0.5 * (1 + r * i) * (1 - s * s);
    sum = sum + weight * nodes[k];
  }
  return sum;
}

TEST(JacobianBounds, HoldWithoutTheMiddleNode) {
  int lower = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::vector<Vec3> nodes = random_element(2, 0.12, seed);
    for (Vec3& p : nodes) p.z = 0;
    const JacobianBounds bounds = element_bounds(nodes, 2);
    const auto at = [&](double u, double v) { return place_of_eight(nodes, u, v); };
    double least = 1;
    constexpr int kSamples = 40;
    constexpr double kStep = 1e-5;
    for (int j = 0; j <= kSamples; ++j)
      for (int i = 0; i <= kSamples; ++i) {
        const double u = 1.0 * i / kSamples, v = 1.0 * j / kSamples;
        const Vec3 xu = at(u + kStep, v) - at(u - kStep, v), xv = at(u, v + kStep) - at(u, v - kStep);
        least = std::min(least, cross(xu, xv).z / (norm(xu) * norm(xv)));
      }
    EXPECT_LE(bounds.proven, least + 1e-6) << seed;
    EXPECT_LE(bounds.proven, jacobian_bounds(nodes, 2).proven);
    lower += bounds.proven < jacobian_bounds(nodes, 2).proven;
  }
  EXPECT_GT(lower, 10);
}

TEST(Bernstein, ProductsAndDerivativesAreThoseOfTheMaps) {
  for (int order = 1; order <= kMostOrder; ++order) {
    const std::vector<Vec3> nodes = random_element(order, 0.2, 7);
    const Bernstein<Vec3> x = bernstein_of(nodes, order);
    const Bernstein<Vec3> xu = derivative_u(x), xv = derivative_v(x), normal = cross_product(xu, xv);
    for (const double u : {0.0, 0.3, 1.0})
      for (const double v : {0.0, 0.6, 1.0}) {
        EXPECT_LT(norm(value_at(x, u, v) - place(nodes, order, u, v)), 1e-12);
        const Vec3 expected = cross(value_at(xu, u, v), value_at(xv, u, v));
        EXPECT_LT(norm(value_at(normal, u, v) - expected), 1e-11);
      }
    constexpr double kStep = 1e-6;
    const Vec3 slope =
        (0.5 / kStep) * (place(nodes, order, 0.3 + kStep, 0.6) - place(nodes, order, 0.3 - kStep, 0.6));
    EXPECT_LT(norm(value_at(xu, 0.3, 0.6) - slope), 1e-7);
  }
}

}  // namespace
}  // namespace delquad
