// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/lp_energy.h"
#include "tests/smoothing/seeds.h"

namespace delquad {
namespace {

/// The error of the derivative by central differences, relative to the largest of all components.
constexpr double kGradientTolerance = 1e-6;

void check_gradient(const PatchBoundary& boundary, const std::vector<Vec2>& seeds, int p,
                    std::uint64_t random) {
  const std::size_t n_boundary = boundary.points.size();
  const SeedFrames frames = random_frames(n_boundary + seeds.size(), random);
  const EnergyAndGradient at = energy_of(boundary, seeds, frames, p);
  ASSERT_GT(at.energy, 0);
  double largest = 0;
  for (const Vec2 g : at.gradient) largest = std::max(largest, norm(g));
  std::vector<Vec2> x = seeds;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (double Vec2::*along : {&Vec2::x, &Vec2::y})
      EXPECT_NEAR(at.gradient[n_boundary + i].*along,
                  slope_of(x[i].*along, 2e-6, [&] { return energy_of(boundary, x, frames, p).energy; }),
                  kGradientTolerance * largest)
          << "p " << p << ", seed " << i << " at " << seeds[i].x << " " << seeds[i].y;
  for (std::size_t i = 0; i < n_boundary; ++i) EXPECT_EQ(at.gradient[i], Vec2{}) << "boundary point " << i;
}

TEST(LpEnergies, GradientAgreesWithDifferencesNearBoundariesAndHoles) {
  for (const int p : {2, 4, 6, 8})
    for (const std::uint64_t seed : {3, 4, 5, 12}) {
      const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0);
      check_gradient(boundary, random_seeds(boundary, seed, 60, 0.05), p, seed);
    }
}

TEST(LpEnergies, GradientAgreesWithDifferencesAtAReentrantCorner) {
  const PatchBoundary boundary = shapes::polygon({{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}});
  for (const int p : {2, 4, 6, 8, 16})
    check_gradient(boundary, {{-0.07, 0.03}, {0.05, -0.02}, {-0.04, -0.06}, {0.4, -0.1}, {-0.5, 0.5}}, p, 1);
}

TEST(LpEnergies, LatticeAlongTheFieldIsStationary) {
  for (const double angle : {0.0, 0.3}) {
    const int n = 7;
    std::vector<Vec2> seeds;
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i) {
        const Vec2 x{double(i) / n, double(j) / n};
        seeds.push_back(
            {std::cos(angle) * x.x - std::sin(angle) * x.y, std::sin(angle) * x.x + std::cos(angle) * x.y});
      }
    const PatchBoundary boundary = shapes::rectangle(1, 1, n, n, angle);
    const SeedFrames frames = equal_frames(boundary.points.size() + seeds.size(), angle);
    for (const int p : {2, 6, 16}) {
      const EnergyAndGradient at = energy_of(boundary, seeds, frames, p);
      const double cell = 2 * std::pow(0.5 / n, p) / (p + 1) / (n * n);
      EXPECT_NEAR(at.energy, n * n * cell, 1e-11 * n * n * cell);
      for (const Vec2 g : at.gradient) EXPECT_LE(norm(g), 1e-10 * n * cell) << p;
    }
  }
}

TEST(LpEnergies, RotationTranslationAndScale) {
  const PatchBoundary boundary = shapes::random_polygon_with_holes(8, 0.2);
  const std::vector<Vec2> seeds = random_seeds(boundary, 8, 80, 0.05);
  const SeedFrames frames = random_frames(boundary.points.size() + seeds.size(), 8);
  const double angle = 0.7, scale = 3.5;
  const Vec2 shift{10, -4};
  const auto turned = [&](Vec2 v) {
    return Vec2{std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
  };
  const auto moved = [&](Vec2 v) { return shift + scale * turned(v); };
  PatchBoundary boundary2 = boundary;
  std::vector<Vec2> seeds2 = seeds;
  SeedFrames frames2 = frames;
  for (Vec2& x : boundary2.points) x = moved(x);
  for (Vec2& x : seeds2) x = moved(x);
  for (Vec2& a : frames2.axis) a = turned(a);
  for (Vec2& s : frames2.slope) s = (1 / scale) * turned(s);
  for (Vec2& x : frames2.from) x = moved(x);
  for (const int p : {2, 6}) {
    const EnergyAndGradient at = energy_of(boundary, seeds, frames, p);
    const EnergyAndGradient at2 = energy_of(boundary2, seeds2, frames2, p);
    EXPECT_NEAR(at2.energy, std::pow(scale, p + 2) * at.energy, 1e-10 * at2.energy);
    double largest = 0;
    for (const Vec2 g : at2.gradient) largest = std::max(largest, norm(g));
    for (std::size_t i = 0; i < at.gradient.size(); ++i)
      EXPECT_LE(norm(at2.gradient[i] - std::pow(scale, p + 1) * turned(at.gradient[i])), 1e-9 * largest);
  }
}

TEST(LpEnergies, AreContinuousAcrossFlips) {
  // The middle seed passes the circle through the others: the energy and its slope do not jump.
  const PatchBoundary boundary = shapes::polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  const auto at = [&](double x) {
    const std::vector<Vec2> seeds = {{-0.3, 0}, {0, -0.3}, {0, 0.3}, {0.3 + x, 0}};
    return energy_of(boundary, seeds, random_frames(8, 3), 6);
  };
  const double kSmall = 1e-7;
  const EnergyAndGradient before = at(-kSmall), after = at(kSmall);
  EXPECT_NEAR(before.energy, after.energy, 1e-5 * before.energy);
  for (std::size_t i = 0; i < before.gradient.size(); ++i)
    EXPECT_LE(norm(before.gradient[i] - after.gradient[i]), 1e-4 * norm(before.gradient[7]));
}

TEST(LpEnergies, AreTheSameBytesOnAnyNumberOfThreads) {
  const PatchBoundary boundary = shapes::annulus(0.4, 1, 60, 150);
  const std::vector<Vec2> seeds = random_seeds(boundary, 5, 20000, 0.012);
  ASSERT_GT(seeds.size(), 3000u);
  const SeedFrames frames = random_frames(boundary.points.size() + seeds.size(), 5);
  on_threads({1, 2, 4}, [&] {
    const EnergyAndGradient at = energy_of(boundary, seeds, frames, 6);
    return std::pair(at.energy, at.gradient);
  });
}

TEST(LpEnergies, RefuseOtherNorms) {
  for (const int p : {-2, 0, 1, 5, 17, 18})
    expect_input_error([p] { LpEnergy energy(p); }, {"expected an even number from 2 to 16"});
}

TEST(LpEnergies, WithoutFreePointsAreDefined) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 2, 2);
  const EnergyAndGradient at = energy_of(boundary, {}, equal_frames(8), 6);
  EXPECT_GT(at.energy, 0);
  for (const Vec2 g : at.gradient) EXPECT_EQ(g, Vec2{});
}

}  // namespace
}  // namespace delquad
