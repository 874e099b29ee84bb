// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/options.h"

// This header has the treatment of quads after matching. Pipelines and layouts use it.

namespace delquad {

struct TreatmentOptions {
  int max_rounds = 20;    ///< most rounds of topology and relocation; a round without changes of topology is
                          ///< the last
  double settled = 0.02;  ///< in the end, vertices rest below moves of this part of an edge, > 0
};

struct TreatmentSummary {
  int rounds = 0;
  int doublets = 0;          ///< removed interior vertices between two quads
  int diamonds = 0;          ///< quads removed by merging opposite corners
  int swaps = 0;             ///< edges rotated within the hexagon of their two quads
  int openings = 0;          ///< pairs of quads added to give a boundary vertex its second quad
  int boundary_repairs = 0;  ///< rings of new quads around bad quads
  int ring_quads = 0;        ///< quads of these rings; each ring has as many new vertices
  int relocated = 0;         ///< moves of vertices
  long long looks = 0;       ///< QuadRelocation::looks(): at most linear in the number of elements
  int stopped = 0;  ///< 1: it stopped before all moves were tried, after as many looks as the patch may take
  double seconds = 0;
};

template <>
struct Counters<TreatmentSummary> {
  using S = TreatmentSummary;
  static constexpr const char* step = "treatment";
  static constexpr auto all = std::tuple(
      counter("rounds", &S::rounds, Over::kMost), counter("doublets", &S::doublets),
      counter("diamonds", &S::diamonds), counter("swaps", &S::swaps), counter("openings", &S::openings),
      counter("boundary_repairs", &S::boundary_repairs), counter("ring_quads", &S::ring_quads),
      counter("relocated", &S::relocated), counter("looks", &S::looks), counter("stopped", &S::stopped),
      counter("seconds", &S::seconds));
};

/// Applies the treatment that the tables of [remacle2013, section 7] include, as in [remacle2012blossom]:
/// doublets, diamonds, swaps of poor pairs, relocation.
///
/// Differences from these sources:
/// - Edits are chosen by the decrease of the sum of (valence - ideal)^2, largest first. Boundary vertices
///   have their own ideal. Two edits may be tried together if the first alone gains nothing.
/// - An edit is kept only if, after local relocation, the elements around are not poorer (eta below 0.3).
/// - A flat boundary vertex with one quad gets a second quad by an opening (QuadTopology::open). Rotations
///   would only move the defect on.
/// - Quads that stay poor get any edit that lifts them. Bad quads in flat boundary corners get a ring of new
///   quads. Quads of eta 0 are remeshed with their neighborhood (LocalRemeshing).
/// - Relocation weighs angles and edge lengths, and a last pass lifts the worst quads.
///
/// Boundary points keep their places and order. The mesh stays conforming, oriented and of the same topology,
/// and leftover triangles stay triangles. Throws std::invalid_argument if the input is not conforming. Quads
/// of eta 0 may remain beside boundary edges some hundred times as long as their quads, or at crowded corners
/// of about one degree.
QuadPatch treat_paper(QuadPatch mesh, const ParametricSize& size, const TreatmentOptions& options = {},
                      TreatmentSummary* summary = nullptr);

/// Applies the treatment after greedy merging [borouchaki1998], as far as is known. Edges between quads are
/// swapped if that brings degrees of vertices nearer to 4 (on the boundary to the ideal of its angle). Inner
/// vertices of two elements are removed. Vertices move toward the mean of the best points for each element
/// around, weighted by 1/delta'^2. The best point makes a square of the opposite diagonal, or an equilateral
/// triangle of the opposite side. A move is kept if the worst element around improves. An edit is kept if
/// that element gets no worse, or stays above half of a square's sine.
QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size,
                           const TreatmentOptions& options = {}, TreatmentSummary* summary = nullptr);

enum class Treatment { kNone, kPaper };

/// Options of recombination.
struct RecombinationOptions {
  std::string solver = "primal-dual";  ///< of matching_solver_names(); also for the counts on curves
  std::string cost = "eta";            ///< of merge_cost_names()
  Treatment treatment = Treatment::kPaper;
  double settled = TreatmentOptions().settled;
};

OptionGroup recombination_group();
RecombinationOptions recombination_options(const Options& options);

}  // namespace delquad
