// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has stage C, the clean-up of irregular vertices. Pipelines, layouts and stage Q use it.

namespace delquad {

struct CleanupOptions {
  int rounds = 60;         ///< rounds of annealing, >= 0; 0: greedy only
  double tolerance = 0.1;  ///< largest loss of quality by an edit in the first round, >= 0; 0 in the last
  long long seed = 1;      ///< of the random edits
};

OptionGroup cleanup_group();
CleanupOptions cleanup_options(const Options& options);

/// The least eta around an edit or relocation never falls below both this and its old value.
inline constexpr double kCleanupFloorEta = 0.5;

struct CleanupSummary {
  int irregular_before = 0;  ///< vertices whose valence is not ideal
  int irregular_after = 0;
  int rotations = 0;  ///< accepted edits by kind, here and below
  int diamonds = 0;
  int doublets = 0;
  int splits = 0;
  int openings = 0;
  long long tried = 0;      ///< neutral moves tried in annealing
  int annealed = 0;         ///< accepted ones among them
  long long relocated = 0;  ///< moves of vertices
  long long looks = 0;      ///< QuadRelocation::looks(): at most linear in the number of elements
  int stopped = 0;  ///< 1: it stopped before all edits were tried, after as many looks as the patch may take
  double seconds = 0;
};

template <>
struct Counters<CleanupSummary> {
  using S = CleanupSummary;
  static constexpr const char* step = "cleanup";
  static constexpr auto all = std::tuple(
      counter("irregular_before", &S::irregular_before), counter("irregular_after", &S::irregular_after),
      counter("rotations", &S::rotations), counter("diamonds", &S::diamonds),
      counter("doublets", &S::doublets), counter("splits", &S::splits), counter("openings", &S::openings),
      counter("tried", &S::tried), counter("annealed", &S::annealed), counter("relocated", &S::relocated),
      counter("looks", &S::looks), counter("stopped", &S::stopped), counter("seconds", &S::seconds));
};

/// Counts the vertices whose valence is not ideal, see ValenceEnergy.
int count_irregular(const QuadPatch& mesh);

/// Lowers the number of irregular vertices of a quad mesh in the parameter plane. The choice of edits and the
/// annealing are own.
///
/// Edits are diamond collapses, edge rotations, vertex splits, doublet removals and openings. An opening
/// gives a boundary vertex one more quad and takes none from its neighbor. The greedy phase keeps an edit if
/// it lowers the sum of (valence - ideal)^2 at nearly no loss of quality. The ideal is 4 inside, and angle /
/// 90 degrees, rounded and at least 1, on the boundary. Annealing then tries a random edit that keeps the sum
/// at each irregular vertex. So pairs of valences 3 and 5 travel until they meet others. It accepts a loss of
/// quality around up to a tolerance that decays to 0, and greedy edits follow. A failed edit is tried again
/// only if an edit changed its surroundings. Quality is the mean over quads of eta - 1.5 * (size deviation)
/// after local relocation. The size deviation of a quad is the mean over its sides of 1 - min(l, 1/l) with l
/// = length / delta'.
///
/// The sum never grows, and the least eta never falls below both kCleanupFloorEta and its old value. No edit
/// makes more quads fail (ElementQuality). Boundary points keep their places and order, and leftover
/// triangles stay. The mesh stays conforming, oriented and of the same topology. Edges without length are
/// opened first. The same input and seed give the same mesh. Time is linear in the number of irregular
/// vertices. Throws std::invalid_argument if the input is not conforming.
QuadPatch clean_up(const QuadPatch& mesh, const ParametricSize& size, const CleanupOptions& options = {},
                   CleanupSummary* summary = nullptr);

}  // namespace delquad
