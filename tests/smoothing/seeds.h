// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/lp_energy.h"
#include "smoothing/cvt/moving_delaunay.h"
#include "tests/support/meshing.h"
#include "tests/support/tri_patches.h"

/// Seeds in a patch, with axes and weights of every kind.
namespace delquad::testing_support {

/// Random seeds, some close to the boundary. The patch lies inside [-1, 1]^2.
inline std::vector<Vec2> random_seeds(const PatchBoundary& boundary, std::uint64_t random, int tries,
                                      double distance) {
  return random_inner_points(boundary, random, tries, distance);
}

/// Frames that differ from seed to seed.
inline SeedFrames random_frames(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  SeedFrames frames;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * shapes::uniform(random);
    frames.axis.push_back({std::cos(t), std::sin(t)});
    frames.weight.push_back(0.5 + shapes::uniform(random));
    frames.slope.push_back({2 * shapes::uniform(random) - 1, 2 * shapes::uniform(random) - 1});
    frames.from.push_back({shapes::uniform(random), shapes::uniform(random)});
  }
  return frames;
}

inline SeedFrames equal_frames(std::size_t n, double angle = 0) {
  return {std::vector<Vec2>(n, {std::cos(angle), std::sin(angle)}), std::vector<double>(n, 1.0),
          std::vector<Vec2>(n), std::vector<Vec2>(n)};
}

/// Points that are not the boundary's.
inline std::vector<Vec2> inner_points(const TriPatch& tri) {
  return {tri.points.begin() + tri.n_boundary, tri.points.end()};
}

struct EnergyAndGradient {
  double energy;
  std::vector<Vec2> gradient;
};

/// For a triangulation made for it.
inline EnergyAndGradient energy_of(const PatchBoundary& boundary, const std::vector<Vec2>& seeds,
                                   const SeedFrames& frames, int p) {
  const MovingDelaunay delaunay(constrained_delaunay(boundary, seeds));
  BoundedVoronoi cells;
  EnergyAndGradient result{std::nan(""), {}};
  if (cells.build(delaunay)) result.energy = LpEnergy(p).evaluate(delaunay, cells, frames, result.gradient);
  return result;
}

}  // namespace delquad::testing_support
