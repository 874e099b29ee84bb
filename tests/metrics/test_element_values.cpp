// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/element_values.h"
#include "metrics/solve/solve.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kOfSteps = 5e-4;  // what critical_step() promises

using Quad = std::array<Vec3, 4>;

const Quad kRectangle = {Vec3{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
/// A rhombus of side 1, with an angle of 60 degrees.
const Quad kRhombus = {Vec3{0, 0, 0}, {1, 0, 0}, {1.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(0.75), 0}};
/// Sides 2 and 1, a height of 1.
const Quad kTrapezium = {Vec3{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {0.5, 1, 0}};
const std::array<Vec3, 3> kEquilateral = {Vec3{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};

template <std::size_t N>
double value(CriterionKind kind, const std::array<Vec3, N>& p, StepLength by = StepLength::kLsDyna,
             double speed = 1) {
  return criterion_value(kind, p, element_shape(p, {0, 0, 1}), by, speed);
}

TEST(ElementValues, OfARectangle) {
  const std::pair<CriterionKind, double> expected[] = {
      {kMinLength, 2},     {kMaxLength, 3}, {kMinHeight, 2},  {kMaxAspect, 1.5},
      {kMinAngle, 90},     {kMaxAngle, 90}, {kMaxWarpage, 0}, {kMinJacobian, 1},
      {kMinGaussRatio, 1}, {kMaxSkew, 0},   {kMaxTaper, 0},   {kMinEta, 1}};
  for (const auto& [kind, x] : expected) EXPECT_NEAR(value(kind, kRectangle), x, 1e-12) << kind;
}

TEST(ElementValues, OfARhombus) {
  EXPECT_NEAR(value(kMinHeight, kRhombus), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(value(kMinAngle, kRhombus), 60, 1e-12);
  EXPECT_NEAR(value(kMaxAngle, kRhombus), 120, 1e-12);
  EXPECT_NEAR(value(kMinJacobian, kRhombus), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(value(kMinGaussRatio, kRhombus), 1, 1e-12);
  EXPECT_NEAR(value(kMaxSkew, kRhombus), 30, 1e-12);
  EXPECT_NEAR(value(kMaxTaper, kRhombus), 0, 1e-12);
}

TEST(ElementValues, OfATrapezium) {
  // The width falls from 2 to 1 along the height; the triangles at the upper corners have an area of 1/2.
  const double gauss = 0.5 / std::sqrt(3.0);
  EXPECT_NEAR(value(kMinGaussRatio, kTrapezium), (1.5 - gauss) / (1.5 + gauss), 1e-12);
  EXPECT_NEAR(value(kMaxTaper, kTrapezium), 1 - 0.5 / 0.75, 1e-12);
  EXPECT_NEAR(value(kMaxSkew, kTrapezium), 0, 1e-12);
}

TEST(ElementValues, OfAQuadThatIsInverted) {
  const Quad dart = {Vec3{0, 0, 0}, {2, 0, 0}, {0.2, 0.2, 0}, {0, 2, 0}};
  EXPECT_LT(value(kMinGaussRatio, dart), 0);
  EXPECT_LT(value(kMinJacobian, dart), 0);
  EXPECT_GT(value(kMaxAngle, dart), 180);
}

TEST(StepLengths, AreThoseOfThePrograms) {
  const auto length = [](const auto& p, StepLength by) { return value(kMinTimeStep, p, by); };
  // The area over the longest side; the shortest side; the distance across.
  EXPECT_NEAR(length(kRectangle, StepLength::kLsDyna), 2, 1e-12);
  EXPECT_NEAR(length(kRectangle, StepLength::kRadioss), 2, 1e-12);
  EXPECT_NEAR(length(kRectangle, StepLength::kAbaqus), 2, 1e-12);
  EXPECT_NEAR(length(kTrapezium, StepLength::kLsDyna), 1.5 / 2, 1e-12);
  EXPECT_NEAR(length(kTrapezium, StepLength::kRadioss), 1, 1e-12);
  EXPECT_NEAR(length(kTrapezium, StepLength::kAbaqus), 2 / std::sqrt(5.0), 1e-12);
  for (const StepLength by : {StepLength::kLsDyna, StepLength::kRadioss, StepLength::kAbaqus})
    EXPECT_NEAR(length(kEquilateral, by), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(value(kMinTimeStep, kRectangle, StepLength::kLsDyna, 4), 0.5, 1e-12);
}

/// 2 over the frequency of an element alone: lumped masses A / 4, and a stiffness of 1 of linear modes.
TEST(CriticalStep, OfOneElement) {
  EXPECT_NEAR(critical_step(quad_grid(1, 1)), 1, kOfSteps);
  Mesh triangle;
  triangle.points.assign(kEquilateral.begin(), kEquilateral.end());
  triangle.triangles = {{0, 1, 2}};
  EXPECT_NEAR(critical_step(triangle), 2 / std::sqrt(6.0), kOfSteps);
}

TEST(CriticalStep, OfRectanglesIsTheirShorterSide) {
  for (const double height : {1.0, 0.4}) {
    Mesh mesh = quad_grid(12, 9);
    const double side = norm(mesh.points[mesh.quads[0][1]] - mesh.points[mesh.quads[0][0]]);
    const double other = norm(mesh.points[mesh.quads[0][3]] - mesh.points[mesh.quads[0][0]]);
    const double angle = 0.7;
    for (Vec3& p : mesh.points)
      p = {p.x * std::cos(angle) / side, p.x * std::sin(angle) / side, p.y * height / other};
    EXPECT_NEAR(critical_step(mesh), height, height * kOfSteps);
  }
}

TEST(CriticalStep, OfInvertedQuadsIsNone) {
  Mesh mesh = quad_grid(3, 3);
  mesh.points[mesh.quads[4][0]] = mesh.points[mesh.quads[4][2]] + Vec3{0.5, 0.5, 0};
  EXPECT_EQ(critical_step(mesh), 0);
}

}  // namespace
}  // namespace delquad
