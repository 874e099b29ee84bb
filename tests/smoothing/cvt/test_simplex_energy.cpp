// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/simplex_energy.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Nodes on [0, 1] and weights of Gauss's rule of ten points: exact to degree 19.
constexpr std::array<std::pair<double, double>, 5> kGauss = {{{0.1488743389816312, 0.2955242247147529},
                                                              {0.4333953941292472, 0.2692667193099963},
                                                              {0.6794095682990244, 0.2190863625159820},
                                                              {0.8650633666889845, 0.1494513491505806},
                                                              {0.9739065285171717, 0.0666713443086881}}};

/// Integral of f over the triangle (0, a, b) with the square's corner pulled to the origin.
template <class F>
double quadrature(Vec2 a, Vec2 b, F f) {
  double sum = 0;
  const auto each = [](auto visit) {
    for (const auto& [node, weight] : kGauss) {
      visit((1 - node) / 2, weight / 2);
      visit((1 + node) / 2, weight / 2);
    }
  };
  each([&](double r, double wr) {
    each([&](double s, double ws) { sum += wr * ws * r * f(r * ((1 - s) * a + s * b)); });
  });
  return sum * cross(a, b);
}

const std::array<std::pair<Vec2, Vec2>, 4> kTriangles = {
    {{{1, 0.2}, {0.3, 0.9}}, {{-0.4, -0.7}, {0.8, -0.5}}, {{1e-3, 2}, {-1e-3, 2}}, {{0.3, 0.9}, {1, 0.2}}}};

template <int P>
void check_value_and_derivatives() {
  for (const auto& [a, b] : kTriangles) {
    const auto value = [&](Vec2 u, Vec2 v) { return simplex_energy<P>(u, v).value; };
    const SimplexEnergy s = simplex_energy<P>(a, b);
    const double expected = quadrature(a, b, [](Vec2 u) { return std::pow(u.x, P) + std::pow(u.y, P); });
    EXPECT_NEAR(s.value, expected, 1e-12 * std::abs(expected)) << P;
    constexpr double kStep = 1e-5;
    const double tolerance = 1e-7 * (norm(s.by_first) + norm(s.by_second));
    const Vec2 dx{kStep, 0}, dy{0, kStep};
    EXPECT_NEAR(s.by_first.x, (value(a + dx, b) - value(a - dx, b)) / (2 * kStep), tolerance) << P;
    EXPECT_NEAR(s.by_first.y, (value(a + dy, b) - value(a - dy, b)) / (2 * kStep), tolerance) << P;
    EXPECT_NEAR(s.by_second.x, (value(a, b + dx) - value(a, b - dx)) / (2 * kStep), tolerance) << P;
    EXPECT_NEAR(s.by_second.y, (value(a, b + dy) - value(a, b - dy)) / (2 * kStep), tolerance) << P;
  }
}

TEST(SimplexEnergies, AgreeWithQuadratureAndDifferences) {
  check_value_and_derivatives<2>();
  check_value_and_derivatives<4>();
  check_value_and_derivatives<6>();
  check_value_and_derivatives<8>();
  check_value_and_derivatives<16>();
}

TEST(SimplexEnergies, ChangeSignWithOrientation) {
  const Vec2 a{1, 0.2}, b{0.3, 0.9};
  EXPECT_GT(simplex_energy<6>(a, b).value, 0);
  EXPECT_DOUBLE_EQ(simplex_energy<6>(a, b).value, -simplex_energy<6>(b, a).value);
}

}  // namespace
}  // namespace delquad
