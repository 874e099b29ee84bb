#pragma once

#include <string>
#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/options.h"

namespace delquad {

struct TreatmentOptions {
  int max_rounds = 20;  ///< rounds of topology and relocation; stops earlier when a round changes no topology
  double settled = 0.02;  ///< in the end vertices rest once they would move by less than this part of an edge
};

struct TreatmentSummary {
  int rounds = 0;
  int doublets = 0;          ///< interior vertices between two quads, removed
  int diamonds = 0;          ///< quads removed by merging two opposite corners
  int swaps = 0;             ///< edges rotated within the hexagon of their two quads
  int openings = 0;          ///< pairs of quads added so that a boundary vertex gets its second one
  int boundary_repairs = 0;  ///< times that a ring of new quads was put around bad ones
  int ring_quads = 0;        ///< quads of those rings; each has as many new vertices
  int relocated = 0;         ///< moves of vertices
  long long looks = 0;       ///< QuadRelocation::looks(): at most linear in the number of elements
  int stopped = 0;           ///< 1: before all moves were tried, after as many looks as the patch may take
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

/// The treatment after matching that the paper's tables include [Remacle et al. 2012, section 7; its
/// Blossom-Quad]: doublets, diamonds, swaps of poor pairs, vertex relocation.
///
/// Differs from the paper:
/// - an edit is chosen by what it takes off the sum of (valence - ideal)^2, largest first, boundary vertices
///   with their own ideal; two edits may be tried together where the first alone gains nothing;
/// - it is kept only if, after local relocation, the elements around are not poorer (eta below 0.3) than
///   before;
/// - a flat boundary vertex with one quad, which rotations would only hand to the next, gets its second by an
///   opening, see QuadTopology::open;
/// - quads that stay poor get any edit that lifts them, and bad ones (flat boundary corners) a ring of new
///   quads; those of eta 0 are in the end remeshed with their neighbourhood, see LocalRemeshing;
/// - relocation weighs angles and edge lengths, and a last pass lifts the worst quads.
///
/// Boundary points stay where they are, in their order; the mesh stays conforming, oriented and of the same
/// topology type; quads stay quads and leftover triangles triangles. Throws std::invalid_argument where the
/// input is not conforming. Quads of eta 0 may be left where edges of the boundary are some hundred times as
/// long as the quads beside them, or where corners of about one degree crowd.
QuadPatch treat_paper(QuadPatch mesh, const ParametricSize& size, const TreatmentOptions& options = {},
                      TreatmentSummary* summary = nullptr);

/// What follows on greedy merging [borouchaki1998], as far as is known: edges between quads are swapped where
/// that brings the degrees of their vertices nearer to 4 (the boundary's: to what its angle asks for), inner
/// vertices of two elements are taken out, and vertices go towards the mean of the points that would be best
/// for each element around, weighted by 1/delta'^2: the corner that makes the diagonal opposite a square's,
/// or the side of a triangle one of an equilateral. A move is kept when the worst element around gets better,
/// an edit when it gets no worse than that or half as good as a square (in the sine of the least corner).
QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size,
                           const TreatmentOptions& options = {}, TreatmentSummary* summary = nullptr);

enum class Treatment { kNone, kPaper };

/// What recombination can be told.
struct RecombinationOptions {
  std::string solver = "primal-dual";  ///< of matching_solver_names(); for the counts on curves, too
  std::string cost = "eta";            ///< of merge_cost_names()
  Treatment treatment = Treatment::kPaper;
  double settled = TreatmentOptions().settled;
};

OptionGroup recombination_group();
RecombinationOptions recombination_options(const Options& options);

}  // namespace delquad
