// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kRounding = 1e-14;  // a few operations on numbers of order one
constexpr double kPi = std::numbers::pi;

TEST(QuadEta, IsOneForSquaresOfAnySizeAndTurn) {
  for (const double size : {1e-9, 1.0, 1e9}) {
    for (const double turn : {0.0, 0.3, 2.0}) {
      const Vec2 e1 = size * Vec2{std::cos(turn), std::sin(turn)}, e2 = perp(e1);
      EXPECT_NEAR(quad_eta({0, 0}, e1, e1 + e2, e2), 1, kRounding);
    }
  }
}

TEST(QuadEta, IsTheAngleRatioForRhombi) {
  for (const double degrees : {10.0, 45.0, 60.0, 120.0, 170.0}) {
    const double angle = degrees * kPi / 180;
    const Vec2 side = {std::cos(angle), std::sin(angle)};
    const double expected = 1 - 2 / kPi * std::abs(kPi / 2 - angle);
    EXPECT_NEAR(quad_eta({0, 0}, {1, 0}, Vec2{1, 0} + side, side), expected, kRounding);
  }
  EXPECT_NEAR(quad_eta({0, 0}, {2, 0}, {3, std::sqrt(3)}, {1, std::sqrt(3)}), 2.0 / 3, kRounding);
}

TEST(QuadEta, IsOneForRectanglesHoweverThin) { EXPECT_EQ(quad_eta({0, 0}, {1, 0}, {1, 1e-6}, {0, 1e-6}), 1); }

TEST(QuadEta, IsZeroWithAReflexCorner) {
  // Measured as if convex, the corner at the second vertex would be 90 degrees.
  EXPECT_EQ(quad_eta({0, 0}, {2, -0.5}, {4, 0}, {2, 3}), quad_eta({4, 0}, {2, 3}, {0, 0}, {2, -0.5}));
  EXPECT_GT(quad_eta({0, 0}, {2, -0.5}, {4, 0}, {2, 3}), 0);
  EXPECT_EQ(quad_eta({0, 0}, {2, 2}, {4, 0}, {2, 3}), 0);
}

TEST(QuadEta, IsZeroForFlatInvertedCrossedAndCollapsedQuads) {
  EXPECT_EQ(quad_eta({0, 0}, {1, 0}, {2, 0}, {1, 1}), 0) << "an angle of 180 degrees";
  EXPECT_EQ(quad_eta({0, 0}, {0, 1}, {1, 1}, {1, 0}), 0) << "clockwise";
  EXPECT_EQ(quad_eta({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0) << "crossed";
  EXPECT_EQ(quad_eta({0, 0}, {1, 0}, {1, 0}, {0, 1}), 0) << "two corners in one point";
  EXPECT_EQ(quad_eta({0, 0}, {0, 0}, {0, 0}, {0, 0}), 0) << "all corners in one point";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(quad_eta({0, 0}, {1, 0}, {nan, 1}, {0, 1}), 0);
}

TEST(QuadEta, SeesSpaceFromTheNormalsSide) {
  const Vec3 a = {0, 0, 0}, b = {1, 0, 1}, c = {1, 1, 1}, d = {0, 1, 0};  // in the plane x = z
  const Vec3 up = {-1, 0, 1};
  EXPECT_NEAR(quad_eta(a, b, c, d, up), 1, kRounding);
  EXPECT_EQ(quad_eta(a, b, c, d, -1 * up), 0);
  EXPECT_EQ(quad_eta(a, d, c, b, up), 0);
}

TEST(QuadEtas, PlanarMeshesAreSeenFromAbove) {
  Mesh mesh;
  mesh.points = {{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}, {2, 0, 5}, {2, 1, 5}};
  mesh.quads = {{0, 1, 2, 3}, {1, 2, 5, 4}};  // the second runs clockwise
  const std::vector<double> eta = quad_etas(mesh);
  ASSERT_EQ(eta.size(), 2u);
  EXPECT_NEAR(eta[0], 1, kRounding);
  EXPECT_EQ(eta[1], 0);
}

TEST(QuadEtas, OtherMeshesHaveEachQuadsOwnNormal) {
  Mesh mesh;  // two faces of a cube, a crossed quad whose own normal vanishes, a dart
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0.9, 0.9, 0}};
  mesh.quads = {{3, 2, 1, 0}, {1, 2, 5, 4}, {0, 1, 3, 2}, {0, 1, 6, 3}, {1, 2, 3, 6}};
  const std::vector<double> eta = quad_etas(mesh);
  EXPECT_NEAR(eta[0], 1, kRounding);
  EXPECT_NEAR(eta[1], 1, kRounding);
  EXPECT_EQ(eta[2], 0);
  EXPECT_GT(eta[3], 0);
  EXPECT_EQ(eta[4], 0);
}

}  // namespace
}  // namespace delquad
