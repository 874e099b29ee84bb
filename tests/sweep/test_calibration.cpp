#include <gtest/gtest.h>

#include <cmath>

#include "sweep/calibration.h"

namespace delquad {
namespace {

/// A mesher whose number of quads is a power of its size.
auto power_law(double at_one, double power) {
  return [=](double scale) { return std::optional(std::round(at_one * std::pow(scale, power))); };
}

TEST(Calibration, IsDoneWithOneRunWhereTheNumberIsRight) {
  const Calibration done = calibrate_scale(1000, power_law(1009, -2));
  EXPECT_EQ(done.runs, 1);
  EXPECT_EQ(done.scale, 1);
  EXPECT_EQ(done.quads, 1009);
}

TEST(Calibration, FindsTheScaleOfPowerLaws) {
  for (const double power : {-2.0, -1.5, -1.0, -3.0})
    for (const double at_one : {400.0, 900.0, 1200.0, 2500.0}) {
      const Calibration done = calibrate_scale(1000, power_law(at_one, power));
      EXPECT_NEAR(done.quads, 1000, 10) << at_one << " " << power;
      EXPECT_NEAR(std::round(at_one * std::pow(done.scale, power)), done.quads, 0.5)
          << "its scale is the one";
      EXPECT_LE(done.runs, 5) << at_one << " " << power;
    }
}

/// Two power laws with a jump between: there is no scale with 1000.
TEST(Calibration, KeepsTheClosestWhereTheNumberJumps) {
  int runs = 0;
  const Calibration done = calibrate_scale(1000, [&](double scale) {
    ++runs;
    return std::optional(std::round((scale < 1.1 ? 1500 : 1150) / (scale * scale)));
  });
  EXPECT_EQ(runs, done.runs);
  EXPECT_LE(runs, kMostCalibrationRuns);
  EXPECT_LT(std::abs(std::log(done.quads / 1000)), std::log(1.25));
  for (const auto& tried : done.tried)
    EXPECT_LE(std::abs(std::log(done.quads / 1000)), std::abs(std::log(tried[1] / 1000)));
}

TEST(Calibration, EndsWhereNothingFollowsTheSize) {
  int runs = 0;
  const Calibration done = calibrate_scale(1000, [&](double) { return ++runs, std::optional(500.0); });
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, EndsWithTheRunBeforeAFailure) {
  const Calibration done = calibrate_scale(
      1000, [](double scale) { return scale == 1 ? std::optional(500.0) : std::optional<double>(); });
  EXPECT_EQ(done.runs, 2);
  EXPECT_EQ(done.quads, 500);
  EXPECT_EQ(done.scale, 1);
}

TEST(Calibration, NeverLeavesTheRangeOfScales) {
  calibrate_scale(1e9, [](double scale) {
    EXPECT_GE(scale, 0.249);
    EXPECT_LE(scale, 4.001);
    return std::optional(100 / (scale * scale));
  });
}

TEST(Calibration, CountsATriangleAsHalfAQuad) {
  Mesh mesh;
  mesh.quads.resize(3);
  mesh.triangles.resize(5);
  EXPECT_EQ(count_of_quads(mesh), 5.5);
}

}  // namespace
}  // namespace delquad
