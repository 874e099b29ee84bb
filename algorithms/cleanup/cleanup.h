#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

struct CleanupOptions {
  int rounds = 60;         ///< of annealing; 0: greedy only
  double tolerance = 0.1;  ///< how much quality an edit may cost in the first round; none in the last
  long long seed = 1;      ///< of the annealing
};

OptionGroup cleanup_group();
CleanupOptions cleanup_options(const Options& options);

/// Neither an edit nor relocation takes the least eta of the quads around below both this and what it was.
inline constexpr double kCleanupFloorEta = 0.5;

struct CleanupSummary {
  int irregular_before = 0;  ///< vertices whose valence is not ideal
  int irregular_after = 0;
  int rotations = 0;  ///< accepted edits by kind
  int diamonds = 0;
  int doublets = 0;
  int splits = 0;
  int openings = 0;
  long long tried = 0;      ///< neutral moves tried while annealing
  int annealed = 0;         ///< of these, accepted
  long long relocated = 0;  ///< moves of vertices
  long long looks = 0;      ///< QuadRelocation::looks(): at most linear in the number of elements
  int stopped = 0;          ///< 1: before all edits were tried, after as many looks as the patch may take
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

/// Vertices whose valence is not ideal, see ValenceEnergy.
int count_irregular(const QuadPatch& mesh);

/// Lowers the number of irregular vertices of a quad mesh.
///
/// Edits are diamond collapses, edge rotations, vertex splits, doublet removals and openings (which give a
/// boundary vertex a quad more and take none from the next). First greedy: an edit is
/// kept when it lowers the sum of (valence - ideal)^2, 4 being ideal inside and angle / 90 degrees, rounded
/// and at least 1, on the boundary, and costs next to no quality. Then annealing: at every irregular vertex
/// that is left, a random edit that leaves the sum as it is, so that pairs of valences 3 and 5 travel until
/// they meet others, is kept while the quality around loses less than a tolerance that decays to 0; greedy
/// edits follow wherever they can. What has failed is not tried again before an edit changes what lies
/// around. Quality is the mean over quads of eta - 1.5 * (size deviation), after
/// local relocation; the size deviation of a quad is the mean over its sides of 1 - min(l, 1/l), l = length /
/// delta'.
///
/// The sum never grows, and the least eta of the mesh never falls below both kCleanupFloorEta and what it
/// was. No edit makes more quads fail, see ElementQuality. Boundary points stay where they are, in their
/// order; the mesh stays conforming, oriented and of the same topology type; leftover triangles stay. Edges
/// without length are opened first. The same input and seed give the same mesh. Time is linear in the number
/// of irregular vertices: after the first scan only they are visited. Throws std::invalid_argument where the
/// input is not conforming.
QuadPatch clean_up(const QuadPatch& mesh, const ParametricSize& size, const CleanupOptions& options = {},
                   CleanupSummary* summary = nullptr);

}  // namespace delquad
