#pragma once

#include <tuple>

#include "base/counters.h"

namespace delquad {

struct OptimisationOptions {
  int passes = 4;           ///< at most; delta and the cross are evaluated anew before each
  int iterations = 25;      ///< of L-BFGS, at most: of the worst quads, then of the others, in each pass
  double size = 0.4;        ///< weight of the edges' lengths, see QuadEnergyWeights
  double alignment = 0.02;  ///< weight of the edges' directions
};

OptionGroup optimisation_group();
OptimisationOptions optimisation_options(const Options& options);

struct OptimisationSummary {
  int untangled = 0;   ///< inverted or flat quads of the input that are so no more
  int held = 0;        ///< vertices kept in place that could move, but for flat quads
  int iterations = 0;  ///< of L-BFGS, those for the worst quads included
  int evaluations = 0;
  double energy_before = 0, energy_after = 0;  ///< of the pass over all quads
  double worst_before = 1, worst_after = 1;    ///< least eta of quads that can move, after untangling
  double seconds = 0;
};

template <>
struct Counters<OptimisationSummary> {
  using S = OptimisationSummary;
  static constexpr const char* step = "optimisation";
  static constexpr auto all = std::tuple(
      counter("untangled", &S::untangled), counter("held", &S::held), counter("iterations", &S::iterations),
      counter("evaluations", &S::evaluations), counter("energy_before", &S::energy_before),
      counter("energy_after", &S::energy_after), counter("worst_before", &S::worst_before, Over::kLeast),
      counter("worst_after", &S::worst_after, Over::kLeast), counter("seconds", &S::seconds));
};

/// The least eta never falls below both this and what it was.
inline constexpr double kOptimisedFloorEta = 0.6;

}  // namespace delquad
