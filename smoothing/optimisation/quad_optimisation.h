#pragma once

#include "fields/cross_field.h"
#include "fields/size_field.h"
#include "mesh/patch.h"

namespace delquad {

struct OptimisationOptions {
  int passes = 3;           ///< delta' and the cross are evaluated anew before each
  int iterations = 40;      ///< of L-BFGS in a pass, at most
  double size = 0.25;       ///< weight of the edges' lengths, see QuadEnergyWeights
  double alignment = 0.02;  ///< weight of the edges' directions
};

struct OptimisationSummary {
  int untangled = 0;   ///< inverted or flat quads of the input that are so no more
  int held = 0;        ///< interior vertices kept in place, by flat quads or leftover triangles
  int iterations = 0;  ///< of L-BFGS, the passes for the worst quads included
  int evaluations = 0;
  double energy_before = 0, energy_after = 0;  ///< of the last pass over all quads
  double worst_before = 1, worst_after = 1;    ///< least eta of quads that can move, after untangling
  double seconds = 0;
};

/// The least eta never falls below both this and what it was.
inline constexpr double kOptimisedFloorEta = 0.5;

/// Moves the interior vertices of a quad mesh together, to the least of QuadEnergy by L-BFGS (Ceres). Before
/// and after, those around the worst quads move by themselves, with a weight on bad quads that lifts these.
///
/// Edges without length are opened and what is inverted or flat is untangled first; vertices of quads where
/// that fails stay. No quad becomes inverted, and the least eta of quads that can move does not fall below
/// both kOptimisedFloorEta and what it was. Connectivity and boundary points stay. The same input gives the
/// same mesh. Throws std::invalid_argument where the input is not conforming.
QuadPatch optimise_vertices(const QuadPatch& mesh, const ParametricSize& size, const CrossField& cross,
                            const OptimisationOptions& options = {}, OptimisationSummary* summary = nullptr);

}  // namespace delquad
