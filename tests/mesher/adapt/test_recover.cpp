// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/adapt.h"
#include "tests/mesher/adapt/ugly_quads.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A smooth function and its derivatives.
double u(double x, double y) { return std::sin(2 * x + 1) * std::exp(y) + std::cos(3 * x * y); }
Vec2 gradient(double x, double y) {
  const double s = std::sin(3 * x * y);
  return {2 * std::cos(2 * x + 1) * std::exp(y) - 3 * y * s, std::sin(2 * x + 1) * std::exp(y) - 3 * x * s};
}
Tensor2 hessian(double x, double y) {
  const double s = std::sin(3 * x * y), c = std::cos(3 * x * y), e = std::exp(y);
  return {-4 * std::sin(2 * x + 1) * e - 9 * y * y * c, 2 * std::cos(2 * x + 1) * e - 3 * s - 9 * x * y * c,
          std::sin(2 * x + 1) * e - 9 * x * x * c};
}

double most(const Tensor2& a, const Tensor2& b) {
  return std::max({std::abs(a.xx - b.xx), std::abs(a.xy - b.xy), std::abs(a.yy - b.yy)});
}

// In units of the mesh's own widths, on squares and on quads a thousand times as wide as high.
TEST(Recover, QuadraticsAreExact) {
  for (const double height : {1.0, 1e-3})
    for (Mesh mesh :
         {ugly_quads(10, 1, height), quad_grid(3, 7, 1, height), triangle_grid(6, 4, 1, height)}) {
      const auto values = values_of(mesh, [&](double x, double y) {
        y /= height;
        return 1 + 2 * x - 3 * y + 1.5 * x * x - 0.7 * x * y + 2.2 * y * y;
      });
      const Recovery made = recover(mesh, values);
      for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const double x = mesh.points[i].x, y = mesh.points[i].y / height;
        const Tensor2& h = made.hessian[i];
        EXPECT_LT(most({h.xx, h.xy * height, h.yy * height * height}, {3, -0.7, 4.4}), 1e-10);
        EXPECT_NEAR(made.gradient[i].x, 2 + 3 * x - 0.7 * y, 1e-11);
        EXPECT_NEAR(made.gradient[i].y * height, -3 - 0.7 * x + 4.4 * y, 1e-11);
      }
    }
}

// As loops make them for solutions that vary along one axis.
TEST(Recover, ASingleRowOfElements) {
  for (const double height : {1e-3, 1.0, 1e3}) {
    const Mesh mesh = quad_grid(8, 1, 1, height);
    const Recovery made =
        recover(mesh, values_of(mesh, [&](double x, double y) { return x * x + 3 * (x + 1) * y / height; }));
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Tensor2& h = made.hessian[i];
      EXPECT_LT(most({h.xx, h.xy * height, h.yy}, {2, 3, 0}), 1e-10);
    }
  }
}

TEST(Recover, ConvergesUpToTheBoundary) {
  std::vector<double> of_hessian, of_gradient;
  for (const int n : {12, 24, 48}) {
    const Mesh mesh = ugly_quads(n);
    const Recovery made = recover(mesh, values_of(mesh, u));
    double worst = 0, worst_gradient = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const auto [x, y, z] = mesh.points[i];
      worst = std::max(worst, most(made.hessian[i], hessian(x, y)));
      worst_gradient = std::max(worst_gradient, norm(made.gradient[i] - gradient(x, y)));
    }
    of_hessian.push_back(worst);
    of_gradient.push_back(worst_gradient);
  }
  for (const int k : {1, 2}) {
    EXPECT_GT(std::log2(of_hessian[k - 1] / of_hessian[k]), 1);
    EXPECT_GT(std::log2(of_gradient[k - 1] / of_gradient[k]), 2);
  }
}

// A kink along x = 1/2, where both sides have quadratics of their own.
TEST(Recover, DoesNotCrossFromRegionToRegion) {
  Mesh mesh = quad_grid(8, 8);
  mesh.regions.push_back({2, {}});
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    mesh.quad_region[q] = mesh.points[mesh.quads[q][0]].x < 0.5 ? 0 : 1;
  const Recovery made = recover(mesh, values_of(mesh, [](double x, double y) {
                                  return x < 0.5 ? y * y : y * y + 7 * (x - 0.5) + (x - 0.5) * (x - 0.5);
                                }));
  ASSERT_EQ(made.mesh.points.size(), mesh.points.size() + 9);
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : made.mesh.quads[q])
      EXPECT_LT(most(made.hessian[v], {mesh.quad_region[q] == 0 ? 0.0 : 2.0, 0, 2}), 1e-10);
}

TEST(Recover, ElementsOfOrderTwo) {
  const Mesh mesh = curved_grid(3, 4, 2, false);
  const Recovery made =
      recover(mesh, values_of(mesh, [](double x, double y) { return x * x * x + x * y * y - y; }));
  for (std::size_t i = 0; i < made.mesh.points.size(); ++i) {
    const auto [x, y, z] = made.mesh.points[i];
    EXPECT_LT(most(made.hessian[i], {6 * x, 2 * y, 2 * x}), 1e-8);
  }
  EXPECT_GT(gradient_error(made).whole, 0);
}

// What elements miss of a quadratic is known: of x^2 by cells of width h it is x (h - x), 1/4 in the middle.
TEST(Estimate, OfInterpolation) {
  const double h = 1.0 / 8;
  for (const Mesh& mesh : {quad_grid(8, 8), triangle_grid(8, 8)}) {
    const Recovery made = recover(mesh, values_of(mesh, [](double x, double) { return x * x; }));
    EXPECT_NEAR(interpolation_error(made, kInfinity).whole, h * h / 4, 1e-12);
    EXPECT_NEAR(interpolation_error(made, 1).whole, h * h / 6, 1e-12);
    const ErrorEstimate l2 = interpolation_error(made, 2);
    EXPECT_NEAR(l2.whole, h * h / std::sqrt(30), 1e-12);
    double sum = 0;
    for (const double e : l2.of_elements) sum += e * e;
    EXPECT_NEAR(std::sqrt(sum), l2.whole, 1e-14);
    EXPECT_NEAR(gradient_error(made).whole, h / std::sqrt(3), 1e-12);
  }
  expect_input_error([] { interpolation_error({}, 0.5); }, {"0.5", "expected 1 to infinity"});
}

// Against the true errors, by samples inside of each quad.
TEST(Estimate, EffectivityNearsOne) {
  const Mesh mesh = ugly_quads(24);
  const std::vector<double> values = values_of(mesh, u);
  double of_u = 0, of_gradient = 0;
  constexpr int kSamples = 6;
  for (const auto& v : mesh.quads)
    for (int i = 0; i < kSamples; ++i)
      for (int k = 0; k < kSamples; ++k) {
        const double s = (i + 0.5) / kSamples, t = (k + 0.5) / kSamples;
        const double w[] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
        const double ws[] = {t - 1, 1 - t, t, -t}, wt[] = {s - 1, -s, s, 1 - s};
        Vec3 x, xs, xt;
        double value = 0, vs = 0, vt = 0;
        for (int c = 0; c < 4; ++c) {
          x = x + w[c] * mesh.points[v[c]];
          xs = xs + ws[c] * mesh.points[v[c]];
          xt = xt + wt[c] * mesh.points[v[c]];
          value += w[c] * values[v[c]], vs += ws[c] * values[v[c]], vt += wt[c] * values[v[c]];
        }
        const double area = cross(xs, xt).z;
        const Vec2 off =
            gradient(x.x, x.y) - Vec2{(vs * xt.y - vt * xs.y) / area, (vt * xs.x - vs * xt.x) / area};
        of_u += area / (kSamples * kSamples) * std::pow(u(x.x, x.y) - value, 2);
        of_gradient += area / (kSamples * kSamples) * dot(off, off);
      }
  const Recovery made = recover(mesh, values);
  EXPECT_NEAR(interpolation_error(made, 2).whole / std::sqrt(of_u), 1, 0.02);
  EXPECT_NEAR(gradient_error(made).whole / std::sqrt(of_gradient), 1, 0.02);
}

TEST(Recover, WrongValues) {
  const Mesh mesh = quad_grid(2, 2);
  expect_input_error([&] { recover(mesh, std::vector<double>(4, 1)); }, {"4 values", "9 points"});
  std::vector<double> values(9, 1);
  values[4] = std::nan("");
  expect_input_error([&] { recover(mesh, values); }, {"nan at (0.5, 0.5)", "expected finite"});
  Mesh bent = mesh;
  bent.points[4].z = 1;
  expect_input_error([&] { recover(bent, std::vector<double>(9, 1)); }, {"is not planar"});
}

}  // namespace
}  // namespace delquad
