// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/quad_energy.h"
#include "smoothing/relocation/quad_relocation.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

QuadEnergy<Vec2> energy_of(const QuadPatch& patch, double delta, double theta, double kept,
                           const QuadEnergyWeights& weights) {
  QuadEnergyMesh<Vec2> mesh;
  mesh.points = patch.points;
  mesh.quads = patch.quads;
  for (int v = patch.n_boundary; v < static_cast<int>(patch.points.size()); ++v)
    mesh.moving.push_back({v, {Vec2{delta, 0}, Vec2{0, delta}}});
  mesh.delta.assign(patch.points.size(), delta);
  mesh.least_lengths.assign(patch.quads.size(), {0.05, 0.05, 0.05, 0.05});
  mesh.arm = [theta](int, int) { return Vec2{std::cos(theta), std::sin(theta)}; };
  mesh.kept_sine.assign(patch.quads.size(), kept);
  mesh.weight.assign(patch.quads.size(), 1);
  return {std::move(mesh), weights};
}

/// The gradient, of which every so many components must agree with central differences.
template <class Energy>
std::vector<double> expect_gradient(const Energy& energy, std::vector<double> at, std::size_t every = 1,
                                    double step = 1e-6, double tolerance = 1e-5) {
  std::vector<double> gradient(at.size());
  double value = 0;
  EXPECT_TRUE(energy.evaluate(at.data(), value, gradient.data()));
  for (std::size_t i = 0; i < at.size(); i += every) {
    const double difference = slope_of(at[i], step, [&] {
      EXPECT_TRUE(energy.evaluate(at.data(), value, nullptr));
      return value;
    });
    EXPECT_NEAR(gradient[i], difference, tolerance * std::max(1.0, std::abs(difference)));
  }
  return gradient;
}

TEST(QuadEnergy, GradientAgreesWithCentralDifferences) {
  for (int seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const QuadPatch mesh = jittered(grid_patch(5, 4), seed, 0.2);
    // Each part by itself, and all; with the exponents of both kinds of passes.
    const QuadEnergyWeights all[] = {{0.5, 1, 0, 0, 0},   {4, 2, 0, 0, 0},    {0.5, 1, 0.7, 0, 0},
                                     {0.5, 1, 0, 0.6, 0}, {0.5, 1, 0, 0, 80}, {30, 3, 0.4, 0.1, 80, 7}};
    for (const QuadEnergyWeights& weights : all) {
      const QuadEnergy energy = energy_of(mesh, 0.8, 0.2, 0.05, weights);
      std::vector<double> at(energy.variables());
      std::mt19937_64 random(seed);
      for (double& x : at) x = 0.04 * (shapes::uniform(random) - 0.5);
      expect_gradient(energy, at);
    }
  }
}

TEST(QuadEnergy, GradientInSpaceAgreesWithCentralDifferences) {
  for (int seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const QuadPatch patch = jittered(grid_patch(5, 4), seed, 0.2);
    std::mt19937_64 random(seed);
    const auto number = [&] { return shapes::uniform(random) - 0.5; };
    QuadEnergyMesh<Vec3> mesh;
    for (const Vec2 p : patch.points) mesh.points.push_back({p.x, p.y, 0.2 * p.x * p.x - 0.1 * p.x * p.y});
    mesh.quads = patch.quads;
    // Every other vertex moves one way only.
    for (int v = 0; v < static_cast<int>(patch.points.size()); ++v)
      mesh.moving.push_back({v,
                             {Vec3{0.8 + number(), number(), number()},
                              v % 2 == 0 ? Vec3{number(), 0.8 + number(), number()} : Vec3{}}});
    // Edges of about one delta, and around each wall.
    mesh.delta.assign(patch.points.size(), std::array{0.8, 0.6, 2.4, 4.0}[seed % 4]);
    mesh.least_lengths.assign(patch.quads.size(), {0.3, 0.3, 0.2, 0.1});
    mesh.arm = [](int, int side) { return side % 2 == 0 ? Vec3{0.6, 0.8, 0} : Vec3{}; };
    mesh.kept_sine.assign(patch.quads.size(), 0.02);
    mesh.weight.assign(patch.quads.size(), 0.7);
    const QuadEnergy<Vec3> energy(mesh, {});
    std::vector<double> at(energy.variables());
    for (double& x : at) x = 0.04 * number();
    expect_gradient(energy, at);
  }
}

TEST(QuadEnergy, TheSameOnAnyNumberOfThreads) {
  // Large enough to be shared out.
  const QuadEnergy energy = energy_of(jittered(grid_patch(60, 50), 1, 0.2), 0.9, 0.2, 0.05, {});
  std::vector<double> at(energy.variables()), gradient(at.size());
  std::mt19937_64 random(1);
  for (double& x : at) x = 0.04 * (shapes::uniform(random) - 0.5);
  on_threads({1, 2, 3}, [&] {
    double value = 0;
    EXPECT_TRUE(energy.evaluate(at.data(), value, gradient.data()));
    return std::pair(value, gradient);
  });
  // Vertices that several threads share move, too.
  EXPECT_EQ(expect_gradient(energy, at, 97, 1e-5), gradient);
}

TEST(QuadEnergy, RegularGridIsAMinimum) {
  const QuadPatch grid = grid_patch(5, 4);
  const QuadEnergy energy = energy_of(grid, 1, 0, 0, {});
  const std::vector<double> rest(energy.variables(), 0.0);
  std::vector<double> gradient(rest.size());
  double least = 0;
  ASSERT_TRUE(energy.evaluate(rest.data(), least, gradient.data()));
  for (const double g : gradient) EXPECT_NEAR(g, 0, 1e-12);
  for (int seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<double> at(rest.size());
    for (double& x : at) x = 0.1 * (shapes::uniform(random) - 0.5);
    double value = 0;
    ASSERT_TRUE(energy.evaluate(at.data(), value, nullptr));
    EXPECT_GT(value, least);
  }
}

TEST(QuadEnergy, FiniteWhereQuadsAreInverted) {
  const QuadEnergy energy = energy_of(grid_patch(2, 2), 1, 0, 0.8, {});
  ASSERT_EQ(energy.variables(), 2);
  // The middle goes right by x. The corners at the middles of bottom and top have the sine 1 / sqrt(1 + x^2),
  // 0.8 at x = 0.75. Beyond x = 1 two quads are inverted.
  double before = 0;
  for (const double x : {0.0, 0.3, 0.75 - 1e-5, 0.75 + 1e-5, 0.9, 1.5}) {
    SCOPED_TRACE(x);
    const double at[] = {x, 0}, mirrored[] = {-x, 0};
    double value = 0, other = 0;
    ASSERT_TRUE(energy.evaluate(at, value, nullptr));
    ASSERT_TRUE(energy.evaluate(mirrored, other, nullptr));
    EXPECT_NEAR(value, other, 1e-9 * value);
    EXPECT_GT(value, before);
    before = value;
    expect_gradient(energy, {x, 0.1});
  }
  const double on_another[] = {1, 0};
  EXPECT_FALSE(energy.evaluate(on_another, before, nullptr));
}

TEST(QuadEnergy, SizeAndCrossPull) {
  const QuadPatch grid = grid_patch(4, 4);
  const auto value = [&](double delta, double theta) {
    double result = 0;
    const std::vector<double> rest(18, 0.0);
    EXPECT_TRUE(energy_of(grid, delta, theta, 0, {0, 2, 1, 1, 0}).evaluate(rest.data(), result, nullptr));
    return result;
  };
  const int edges = 24;  // with an interior end
  // At a factor of 1.5 every edge lacks a third; a cross at 45 degrees is as far off as can be.
  EXPECT_NEAR(value(1.5, 0) - value(1, 0), edges / 3.0, 0.02 * edges);
  EXPECT_NEAR(value(1 / 1.5, 0) - value(1, 0), edges / 3.0, 0.02 * edges);
  EXPECT_NEAR(value(1, std::atan(1.0)) - value(1, 0), edges, 1e-9);
}

TEST(QuadEnergy, WallsHoldLengthsAndLevelOff) {
  const QuadPatch grid = grid_patch(4, 4);
  const double short_wall = QuadLimits{}.short_wall(), long_wall = QuadLimits{}.long_wall();
  double of_shapes = 0;
  const auto value = [&](double delta) {
    double result = 0;
    const std::vector<double> rest(18, 0.0);
    EXPECT_TRUE(energy_of(grid, delta, 0, 0, {0, 2, 0, 0}).evaluate(rest.data(), result, nullptr));
    return result - of_shapes;
  };
  of_shapes = value(1);
  EXPECT_EQ(value(1 / (long_wall - 1e-9)), 0);
  EXPECT_EQ(value(1 / (short_wall + 1e-9)), 0);
  // A tenth beyond, to either side, costs the same; five times as far not much more than twice.
  EXPECT_GT(value(1 / (1.1 * long_wall)), 1);
  EXPECT_NEAR(value(1 / (1.1 * long_wall)), value(1.1 / short_wall), 1e-9);
  EXPECT_LT(value(5 / short_wall), 1.2 * value(2 / short_wall));
}

}  // namespace
}  // namespace delquad
