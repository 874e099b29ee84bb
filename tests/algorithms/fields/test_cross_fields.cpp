// SPDX-License-Identifier: GPL-3.0-or-later
#include <complex>
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angle between two crosses, in [0, pi/4].
double apart(double theta, double other) { return std::abs(std::remainder(theta - other, kPi / 2)); }

int sum_of(const std::vector<Singularity>& singularities) {
  int sum = 0;
  for (const auto& s : singularities) sum += s.index;
  return sum;
}

TEST(HarmonicCross, RectangleIsConstantAtAnyRotation) {
  for (const double angle : {0.0, 20 * kPi / 180, 37 * kPi / 180, 45 * kPi / 180, 1.0}) {
    const auto background = background_of(shapes::rectangle(2, 1, 40, 20, angle));
    const HarmonicCrossField field(background);
    std::mt19937_64 random(1);
    int hint = -1;
    for (int i = 0; i < 1000; ++i) {
      const Cross z = field.at(random_point(background->triangles(), random), hint);
      EXPECT_LE(apart(z.angle(), angle), 1e-13);
      EXPECT_NEAR(std::hypot(z.c, z.s), 1, 1e-12);
    }
    EXPECT_TRUE(field.singularities().empty());
    EXPECT_EQ(field.index_sum(), 4);
  }
}

TEST(HarmonicCross, RectilinearShapesAreConstant) {
  for (const auto& patch :
       {shapes::rotated(shapes::l_shape(6), 0.3),
        shapes::rotated(shapes::polygon({{0, 0}, {5, 0}, {5, 5}, {4, 5}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}, 4),
                        0.3)}) {
    const auto background = background_of(patch);
    const HarmonicCrossField field(background);
    std::mt19937_64 random(1);
    int hint = -1;
    for (int i = 0; i < 300; ++i) {
      EXPECT_LE(apart(field.at(random_point(background->triangles(), random), hint).angle(), 0.3), 1e-12);
    }
    EXPECT_TRUE(field.singularities().empty());
    EXPECT_EQ(field.index_sum(), 4);
  }
}

TEST(HarmonicCross, AnnulusIsPolar) {
  const auto background = background_of(shapes::annulus(0.5, 1, 80, 160));
  const HarmonicCrossField field(background);
  EXPECT_TRUE(field.singularities().empty());
  EXPECT_EQ(field.index_sum(), 0);
  EXPECT_EQ(field.euler_characteristic(), 0);
  std::mt19937_64 random(1);
  int hint = -1;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 u = random_point(background->triangles(), random);
    EXPECT_LE(apart(field.at(u, hint).angle(), std::atan2(u.y, u.x)), 5 * kPi / 180);  // coarse triangles
  }
}

TEST(HarmonicCross, AnnulusConvergesToTheClosedForm) {
  // z = (a r^4 + b r^-4) exp(4 i phi), 1 on both circles.
  const double inner = 0.7, outer = 1, p = std::pow(inner, 4);
  const double a = (1 - p) / (1 - p * p), b = p * (1 - p) / (1 - p * p);
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int n = level == 0 ? 100 : 400;
    const auto background = background_of(shapes::annulus(inner, outer, n, n));
    const HarmonicCrossField field(background);
    std::mt19937_64 random(1);
    int hint = -1;
    error[level] = 0;
    for (int i = 0; i < 2000; ++i) {
      const double r = 0.75 + 0.2 * shapes::uniform(random), phi = 2 * kPi * shapes::uniform(random);
      const Cross z = field.at({r * std::cos(phi), r * std::sin(phi)}, hint);
      const double r4 = std::pow(r, 4);
      const std::complex<double> difference = std::complex(z.c, z.s) - std::polar(a * r4 + b / r4, 4 * phi);
      error[level] += std::norm(difference) / 2000;
    }
    error[level] = std::sqrt(error[level]);
  }
  EXPECT_LT(error[0], 0.15);
  EXPECT_LT(error[1], 0.6 * error[0]);
}

TEST(HarmonicCross, DiskHasFourSingularities) {
  for (const int n : {24, 60, 200}) {
    const HarmonicCrossField field(background_of(shapes::disk(1, n)));
    ASSERT_EQ(sum_of(field.singularities()), 4) << n;
    for (const auto& s : field.singularities()) {
      EXPECT_GT(s.index, 0);
      EXPECT_LT(norm(s.at), 0.8);
    }
    EXPECT_EQ(field.index_sum(), 4);
    EXPECT_EQ(field.euler_characteristic(), 1);
  }
}

TEST(HarmonicCross, EachHoleOfAPlateHasFour) {
  const HarmonicCrossField field(background_of(shapes::plate_with_holes(2, 100, 4, 0.14, 44)));
  EXPECT_EQ(field.euler_characteristic(), -15);
  EXPECT_EQ(field.index_sum(), -60);
  EXPECT_EQ(sum_of(field.singularities()), -64);  // the square's own corners have 4
  for (const auto& s : field.singularities()) EXPECT_EQ(s.index, -1);
}

TEST(HarmonicCross, CornersOfAnyAngle) {
  for (const int per_side : {1, 2, 10}) {
    for (double degrees = 5; degrees < 180; degrees += 5) {
      SCOPED_TRACE(degrees);
      const double t = degrees * kPi / 180;
      // A parallelogram with corners of t and pi - t, one side along the x axis.
      const Vec2 side = {std::cos(t), std::sin(t)};
      const auto patch = shapes::polygon({{0, 0}, {2, 0}, Vec2{2, 0} + side, side}, per_side);
      const auto background = background_of(patch);
      const HarmonicCrossField field(background);
      EXPECT_EQ(field.index_sum(), 4);
      std::mt19937_64 random(1);
      int hint = -1;
      for (int i = 0; i < 50; ++i) {
        const Cross z = field.at(random_point(background->triangles(), random), hint);
        EXPECT_TRUE(std::isfinite(z.c) && std::isfinite(z.s));
      }
      for (const Vec2 corner : patch.points) EXPECT_TRUE(std::isfinite(field.at(corner, hint).angle()));
      // Aligned with the boundary exactly at the middle of its edges (unless refinement has split them).
      for (const auto& [i, j] : patch.edges) {
        const Vec2 middle = 0.5 * (patch.points[i] + patch.points[j]);
        const Vec2 d = patch.points[j] - patch.points[i];
        bool split = false;
        for (const auto& on : background->boundary_points())
          split |= on.from == patch.point_node[i] && on.t > 0;
        if (split) continue;
        EXPECT_LE(apart(field.at(middle, hint).angle(), std::atan2(d.y, d.x)), 1e-9);
      }
    }
  }
}

TEST(HarmonicCross, IndexSumIsEulersOnRandomPolygons) {
  int with_holes = 0, singular = 0;
  for (int seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const auto patch = shapes::random_polygon_with_holes(seed, seed % 2 ? 0.05 : 0);
    const HarmonicCrossField field(background_of(patch));
    int loops = 0;
    for (std::size_t i = 0; i < patch.edges.size(); ++i) loops += patch.edges[i][1] != patch.edges[i][0] + 1;
    EXPECT_EQ(field.euler_characteristic(), 2 - loops);
    EXPECT_EQ(field.index_sum(), 4 * field.euler_characteristic());
    with_holes += loops > 1;
    singular += !field.singularities().empty();
  }
  EXPECT_GT(with_holes, 50);
  EXPECT_GT(singular, 50);
}

TEST(HarmonicCross, TouchingPatchesHaveTheirOwnFields) {
  // A square with a rotated square inside, both patches.
  const PatchBoundary inner = shapes::polygon({{2, 1}, {3, 2}, {2, 3}, {1, 2}}, 10);
  PatchBoundary outer = shapes::rectangle(4, 4, 40, 40);
  shapes::add_polygon(outer, {{2, 1}, {1, 2}, {2, 3}, {3, 2}}, {10, 10, 10, 10});
  const std::vector<PatchBoundary> patches = {outer, inner};
  const auto background = std::make_shared<const BackgroundMesh>(patches);
  const HarmonicCrossField field(background);
  EXPECT_EQ(field.euler_characteristic(), 1);
  EXPECT_EQ(field.index_sum(), 4);
  std::mt19937_64 random(1);
  int hint = -1;
  for (int i = 0; i < 200; ++i) {
    const double x = shapes::uniform(random), y = shapes::uniform(random);
    const Vec2 u = Vec2{2, 1} + x * Vec2{0.999, 0.999} + y * Vec2{-0.999, 0.999};
    EXPECT_LE(apart(field.at(u, hint).angle(), kPi / 4), 1e-12);
  }
}

TEST(HarmonicCross, TurnsWithTheDomain) {
  const auto patch = shapes::random_polygon_with_holes(8, 0.05);
  const auto background = background_of(patch);
  const HarmonicCrossField field(background), turned(background_of(shapes::rotated(patch, kPi / 2)));
  EXPECT_EQ(sum_of(field.singularities()), sum_of(turned.singularities()));
  std::mt19937_64 random(1);
  int hint = -1, turned_hint = -1;
  double mean = 0;
  constexpr int kPoints = 2000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec2 u = random_point(background->triangles(), random);
    mean += apart(field.at(u, hint).angle(), turned.at(perp(u), turned_hint).angle()) / kPoints;
  }
  EXPECT_LT(mean, 2 * kPi / 180);  // the triangulations may differ
}

TEST(ExpressionCross, IsTheAngle) {
  const auto field = make_expression_cross("atan2(1, -2*x) + y");
  int hint = -1;
  EXPECT_LE(apart(field->at({0.3, 0.2}, hint).angle(), std::atan2(1, -0.6) + 0.2), 1e-14);
  EXPECT_THROW(make_expression_cross("1/x")->at({0, 0}, hint), InputError);
  EXPECT_THROW(make_expression_cross("x +"), InputError);
}

TEST(GradientCross, FollowsTheGradient) {
  const auto field = make_gradient_cross(make_expression_size("1 + x^2 + 3*x*y + y"), 1e-6);
  int hint = -1;
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec2 u = {shapes::uniform(random), shapes::uniform(random)};
    EXPECT_LE(apart(field->at(u, hint).angle(), std::atan2(3 * u.x + 1, 2 * u.x + 3 * u.y)), 1e-8);
  }
  EXPECT_EQ(make_gradient_cross(make_constant_size(1), 1e-6)->at({0, 0}, hint).c, 1);
  EXPECT_THROW(make_gradient_cross(make_constant_size(1), 0), InputError);
}

TEST(Cross, AlongIsAFourthPower) {
  for (double t = -3; t < 3; t += 0.1) {
    const Cross z = Cross::along({5 * std::cos(t), 5 * std::sin(t)});
    EXPECT_NEAR(z.c, std::cos(4 * t), 1e-14);
    EXPECT_NEAR(z.s, std::sin(4 * t), 1e-14);
  }
  EXPECT_EQ(Cross::along({0, -3}).c, 1);
  EXPECT_EQ(Cross::along({0, -3}).s, 0);
}

}  // namespace
}  // namespace delquad
