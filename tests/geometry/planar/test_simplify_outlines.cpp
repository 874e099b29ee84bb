// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/simplify_outlines.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr int kPoints = 1000;

/// A ring around a center whose radius swings by `noise`.
std::vector<Vec2> noisy_ring(Vec2 centre, double radius, double noise) {
  std::vector<Vec2> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * (i % kPoints) / kPoints;
    const double r = radius + noise * std::sin(157.0 * angle);
    points.push_back(centre + r * Vec2{std::cos(angle), std::sin(angle)});
  }
  return points;
}

PlanarModel model_of_rings(const std::vector<std::vector<Vec2>>& rings) {
  PlanarModel model{"test", {}, {}};
  for (const auto& ring : rings) {
    model.loops.push_back({{static_cast<int>(model.curves.size())}, "", ""});
    model.curves.push_back({make_polyline(ring), "", ""});
    model.curves.back().is_data = true;
  }
  return model;
}

double distance(const Curve& curve, Vec2 x) {
  double least = 1e300;
  for (int i = 0; i < 4 * kPoints; ++i) least = std::min(least, norm(curve.point(i / (4.0 * kPoints)) - x));
  return least;
}

TEST(SimplifyOutlines, WhatGoesLiesWithinTheTolerance) {
  constexpr double kTolerance = 0.02;
  const std::vector<Vec2> ring = noisy_ring({0, 0}, 1, 0.004);
  std::vector<Warning> warnings;
  const PlanarModel model = simplify_outlines(
      model_of_rings({ring}), [](int, const Vec3&) { return kTolerance; }, false, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  const Curve& shape = *model.curves[0].shape;
  EXPECT_LE(shape.fixed_parameters().size(), 40u);
  EXPECT_EQ(shape.point(0), shape.point(1));
  double farthest = 0;
  for (const Vec2 x : ring) farthest = std::max(farthest, distance(shape, x));
  EXPECT_LE(farthest, 1.01 * kTolerance);
  EXPECT_GT(farthest, 0.3 * kTolerance);
}

TEST(SimplifyOutlines, ChannelsThatAreNarrowerThanTheToleranceStayOpen) {
  // Two rings whose swings mesh with each other at a tenth of the tolerance.
  const auto outer = noisy_ring({0, 0}, 1, 0.01), inner = noisy_ring({0, 0}, 0.998, 0.01);
  std::vector<Warning> warnings;
  const PlanarModel model = simplify_outlines(
      model_of_rings({outer, inner}), [](int, const Vec3&) { return 0.02; }, false, warnings);
  double least = 1e300;
  for (int i = 0; i < kPoints; ++i) {
    const double t = i / double(kPoints);
    EXPECT_LT(norm(model.curves[1].shape->point(t)), 1.01);
    least = std::min(least, distance(*model.curves[0].shape, model.curves[1].shape->point(t)));
  }
  EXPECT_GT(least, 0);
}

TEST(SimplifyOutlines, SharedPointsAndWhatIsNoDataStay) {
  // Two squares with a wavy side in common, whose ends both have; and a circle.
  std::vector<Vec2> side;
  for (int i = 0; i <= 100; ++i) side.push_back({0.001 * std::sin(i), i / 100.0});
  std::vector<Vec2> left = side, right = side;
  for (const Vec2 p : {Vec2{-1, 1}, Vec2{-1, 0}, side[0]}) left.push_back(p);
  for (const Vec2 p : {Vec2{1, 1}, Vec2{1, 0}, side[0]}) right.push_back(p);
  PlanarModel model = model_of_rings({left, right});
  model.curves.push_back({make_circle({0.5, 0.5}, 0.2), "", ""});
  const auto circle = model.curves[2].shape;
  std::vector<Warning> warnings;
  model = simplify_outlines(
      std::move(model), [](int, const Vec3&) { return 0.05; }, false, warnings);
  EXPECT_EQ(model.curves[2].shape, circle);
  for (const int c : {0, 1}) {
    const std::vector<double> corners = model.curves[c].shape->fixed_parameters();
    ASSERT_EQ(corners.size(), 3u);
    EXPECT_EQ(model.curves[c].shape->point(corners[0]), side.back());
  }
  for (const ModelCurve& curve : model.curves) EXPECT_FALSE(curve.is_data);
  PlanarModel by_hand = model_of_rings({left});
  by_hand.curves[0].is_data = false;
  const auto shape = by_hand.curves[0].shape;
  EXPECT_EQ(simplify_outlines(
                by_hand, [](int, const Vec3&) { return 0.05; }, false, warnings)
                .curves[0]
                .shape,
            shape);
}

}  // namespace
}  // namespace delquad
