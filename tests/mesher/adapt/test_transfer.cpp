// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/adapt.h"
#include "tests/mesher/adapt/ugly_quads.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr Transfer kAll[] = {Transfer::kInterpolated, Transfer::kConservative, Transfer::kBounded};

/// The integral of bilinear values, by the middles' Jacobians of two places each way, which is exact.
double integral_of(const Mesh& mesh, const std::vector<double>& values) {
  double sum = 0;
  const double g = 0.5 / std::sqrt(3);
  for (const auto& v : mesh.quads)
    for (const double s : {0.5 - g, 0.5 + g})
      for (const double t : {0.5 - g, 0.5 + g}) {
        const double w[] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
        const double ws[] = {t - 1, 1 - t, t, -t}, wt[] = {s - 1, -s, s, 1 - s};
        Vec3 xs, xt;
        double value = 0;
        for (int c = 0; c < 4; ++c) {
          xs = xs + ws[c] * mesh.points[v[c]];
          xt = xt + wt[c] * mesh.points[v[c]];
          value += w[c] * values[v[c]];
        }
        sum += cross(xs, xt).z * value / 4;
      }
  return sum;
}

double step(double x, double y) { return x + 0.5 * y < 0.7 ? 1 : -1; }

TEST(Transfer, LinearFieldsStay) {
  const auto linear = [](double x, double y) { return 2 - 3 * x + 5 * y; };
  for (const double height : {1.0, 1e-3}) {
    const Mesh from = ugly_quads(7, 1, height), to = ugly_quads(10, 1, height);
    for (const Transfer how : kAll) {
      const auto made = transfer_points(from, values_of(from, linear), to, how);
      const auto wanted = values_of(to, linear);
      for (std::size_t i = 0; i < made.size(); ++i) EXPECT_NEAR(made[i], wanted[i], 1e-10);
    }
  }
}

// Bilinear functions of a parallelogram's own coordinates.
TEST(Transfer, BilinearFieldsStayInQuads) {
  Mesh from = quad_grid(3, 2), to = quad_grid(6, 4);
  const auto wanted = values_of(to, [](double x, double y) { return 1 + x * y; });
  const auto values = values_of(from, [](double x, double y) { return 1 + x * y; });
  for (Mesh* mesh : {&from, &to})
    for (Vec3& p : mesh->points) p = {p.x + 0.3 * p.y, 0.01 * p.y, 0};
  const auto made = transfer_points(from, values, to);
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_NEAR(made[i], wanted[i], 1e-13);
}

TEST(Transfer, IntegralsAndBoundsStay) {
  const Mesh from = ugly_quads(9), to = ugly_quads(13);
  const std::vector<double> values = values_of(from, step);
  const double before = integral_of(from, values);
  const auto conservative = transfer_points(from, values, to, Transfer::kConservative);
  EXPECT_NEAR(integral_of(to, conservative), before, 1e-12);
  EXPECT_GT(std::ranges::max(conservative), 1.01);  // the projection overshoots
  const auto bounded = transfer_points(from, values, to, Transfer::kBounded);
  EXPECT_NEAR(integral_of(to, bounded), before, 1e-12);
  EXPECT_LE(std::ranges::max(bounded), 1 + 1e-14);
  EXPECT_GE(std::ranges::min(bounded), -1 - 1e-14);
  // Far from the step nothing changes.
  for (std::size_t i = 0; i < to.points.size(); ++i)
    if (to.points[i].x > 0.95) {
      EXPECT_NEAR(bounded[i], -1, 0.05);
    }
  // On the same mesh the projection changes nothing.
  const auto same = transfer_points(from, values, from, Transfer::kConservative);
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(same[i], values[i], 1e-11);
}

double area_of(const Mesh& mesh, int element) {
  const auto& v = mesh.quads[element];
  return cross(mesh.points[v[2]] - mesh.points[v[0]], mesh.points[v[3]] - mesh.points[v[1]]).z / 2;
}

TEST(Transfer, ValuesOfElements) {
  const Mesh from = ugly_quads(9), to = ugly_quads(13);
  std::vector<double> values;
  for (const auto& v : from.quads) values.push_back(step(from.points[v[0]].x, from.points[v[0]].y));
  const auto whole = [](const Mesh& mesh, const std::vector<double>& of) {
    double sum = 0;
    for (int e = 0; e < std::ssize(of); ++e) sum += area_of(mesh, e) * of[e];
    return sum;
  };
  for (const Transfer how : {Transfer::kConservative, Transfer::kBounded}) {
    const auto made = transfer_elements(from, values, to, how);
    EXPECT_NEAR(whole(to, made), whole(from, values), 1e-12);
    EXPECT_LE(std::ranges::max(made), 1 + 1e-12);
  }
  for (const double x : transfer_elements(from, values, to)) EXPECT_EQ(std::abs(x), 1);
}

// A finer polygon of the same circle: points outside get what is nearest.
TEST(Transfer, BesideACurvedOutline) {
  const auto disc = [](int n) {
    Mesh mesh = quad_grid(n, n, 2, 2);
    for (Vec3& p : mesh.points) {
      const double x = p.x - 1, y = p.y - 1;
      p = {x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2), 0};
    }
    return mesh;
  };
  const Mesh from = disc(8), to = disc(21);
  const auto values = values_of(from, [](double x, double y) { return 3 + x + y; });
  for (const Transfer how : kAll) {
    const auto made = transfer_points(from, values, to, how);
    for (std::size_t i = 0; i < made.size(); ++i)
      EXPECT_NEAR(made[i], 3 + to.points[i].x + to.points[i].y, how == Transfer::kInterpolated ? 0.03 : 0.1);
  }
  EXPECT_NEAR(integral_of(to, transfer_points(from, values, to, Transfer::kConservative)),
              integral_of(from, values), 1e-12);
}

TEST(Transfer, WrongInput) {
  const Mesh mesh = quad_grid(2, 2);
  expect_input_error([&] { transfer_points(mesh, std::vector<double>(4, 1), mesh); },
                     {"4 values", "9 points"});
  expect_input_error([&] { transfer_elements(mesh, std::vector<double>(9, 1), mesh); },
                     {"9 values", "4 triangles and quads"});
}

}  // namespace
}  // namespace delquad
