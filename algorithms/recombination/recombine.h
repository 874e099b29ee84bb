#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "algorithms/recombination/dual_graph.h"
#include "algorithms/recombination/merge_cost.h"
#include "base/counters.h"
#include "base/matching/matching.h"
#include "delquad/mesh.h"

namespace delquad {

struct RecombineSummary {
  int triangles = 0;           ///< given
  int split_chords = 0;        ///< sides between boundary points that had to be cut, see below
  int extra_edges = 0;         ///< extra graph edges at boundary vertices
  int matched_extra = 0;       ///< of these, matched and repaired
  int pentagon_swaps = 0;      ///< repairs by swapping
  int duplications = 0;        ///< repairs by duplicating the boundary vertex
  int leftover_triangles = 0;  ///< 0 when the boundary is even, else 1 for each odd component
  long long cost = 0;          ///< of the matching
  double graph_seconds = 0, matching_seconds = 0, merge_seconds = 0;
  std::vector<SummaryField> solver = {};  ///< what it has to say itself
};

template <>
struct Counters<RecombineSummary> {
  using S = RecombineSummary;
  static constexpr const char* step = "recombination";
  static constexpr auto all = std::tuple(
      counter("triangles", &S::triangles), counter("split_chords", &S::split_chords),
      counter("extra_edges", &S::extra_edges), counter("matched_extra", &S::matched_extra),
      counter("pentagon_swaps", &S::pentagon_swaps), counter("duplications", &S::duplications),
      counter("leftover_triangles", &S::leftover_triangles), counter("cost", &S::cost),
      counter("graph_seconds", &S::graph_seconds), counter("matching_seconds", &S::matching_seconds),
      counter("merge_seconds", &S::merge_seconds), counter("solver", &S::solver));
};

/// Merges the triangles of a patch two by two by minimum-cost perfect matching on the dual graph
/// (Blossom-Quad, Remacle et al. 2011), cost 1 - eta with reflex quads dearer than any convex one.
///
/// An even boundary gives quads only. An odd one leaves exactly one triangle in each odd component: the one
/// whose absence makes the rest cheapest. Vertices are never moved; new ones come last (from duplication,
/// placed where the worst quad around is best; from cut spanning sides). The number of quads is half the
/// triangles, plus one for each duplication and for each cut spanning side.
///
/// Differs from the paper, which takes the existence of a perfect matching from the theorem on cubic graphs
/// without bridges although a triangle on the boundary has degree four: the graph may have none (18 points on
/// a circle suffice). Then every spanning side (an interior one that joins two boundary points) is cut in
/// two, and a perfect matching exists. Proof by Tutte: no triangle has two boundary sides any more, so the
/// extra edges link the triangles of each boundary loop to a cycle. Let S be a set of s1 triangles with a
/// boundary side and s3 without, whose removal leaves at least s1 + s3 + 2 odd components, and r the number
/// of runs into which S cuts those cycles. A component without boundary sides has at least three edges to S.
/// The others have four a run: two along the cycle, and two because a path between boundary points that is no
/// such side has two edges; there are at most r of them. S has 4 s1 + 3 s3 edge ends, of which 2 (s1 - r)
/// lead along a cycle to S itself. So 3 (s1 + s3 + 2 - r) + 4 r <= 2 s1 + 3 s3 + 2 r, that is s1 + 6 <= r;
/// but each run ends at another triangle of S, hence r <= s1. With an odd number of triangles the same bound
/// leaves room for one odd component too many, which is where the leftover comes from.
/// `cost`: in place of 1 - eta; null: that.
QuadPatch recombine(const TriPatch& tri, const MatchingSolver& solver, RecombineSummary* summary = nullptr,
                    long long extra_edge_cost = kExtraEdgeCost, const AddedCost& cost = nullptr);

/// Cuts every interior side that joins two boundary points at its middle: its two triangles become four.
/// Returns how many sides were cut; the new points come last. The number of triangles keeps its parity.
int split_spanning_sides(TriPatch& tri);

/// Which pairs of triangles may become quads.
struct GreedyOptions {
  double least_eta = 0.1;     ///< of a merged quad, above 0
  bool longest_side = false;  ///< only across a side that is the longest of both triangles
  /// A triangle without partner may take one from a quad, whose other triangle finds another; at most so many
  /// quads are made anew for it.
  int exchanges = 3;
};

/// Merges pairs of triangles in the order of the quads' eta, best first, each triangle once; then by
/// exchanges. What finds no partner stays a triangle. Points are kept. [borouchaki1998]
QuadPatch recombine_greedily(const TriPatch& tri, const GreedyOptions& options = {},
                             RecombineSummary* summary = nullptr);

/// Two triangles which an extra edge of the dual graph has matched: the first and the last of the fan at a
/// boundary point. Both start with that point; both are counterclockwise.
struct FanEnds {
  std::array<int, 3> first, last;
};

struct BoundaryRepairSummary {
  int pentagon_swaps = 0;
  int duplications = 0;
};

/// Turns each pair of fan ends into quads and adds them to the mesh, which holds everything but them.
///
/// With one quad (b, q, m, r) between the ends (b, p, q) and (b, r, s), the three may become (b, p, q, m) and
/// (b, m, r, s): the pentagon swap. Always possible: the boundary point b is duplicated. The new interior
/// point b' takes its place in all that lies between, and the ends become (b, p, q, b') and (b, b', r, s). It
/// is chosen where its worst quad is clearly better than the swap's. Each b' is placed where the worst of its
/// elements is best. [Remacle et al. 2011, section 4]
///
/// Differs from the paper, which swaps whenever it can and leaves the place of b' open.
BoundaryRepairSummary repair_fans(QuadPatch& mesh, const std::vector<FanEnds>& pairs);

}  // namespace delquad
