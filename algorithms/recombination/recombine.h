// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "algorithms/recombination/dual_graph.h"
#include "algorithms/recombination/merge_cost.h"
#include "base/counters.h"
#include "base/matching/matching.h"
#include "delquad/mesh.h"

// This header merges triangles into quads (stages B and G). Pipelines and layouts use it.

namespace delquad {

struct RecombineSummary {
  int triangles = 0;           ///< given
  int split_chords = 0;        ///< cut sides between boundary points, see below
  int extra_edges = 0;         ///< extra graph edges at boundary vertices
  int matched_extra = 0;       ///< matched and repaired extra edges
  int pentagon_swaps = 0;      ///< repairs by swapping
  int duplications = 0;        ///< repairs by duplicating the boundary vertex
  int leftover_triangles = 0;  ///< 0 if the boundary is even, else 1 for each odd component
  long long cost = 0;          ///< cost of the matching
  double graph_seconds = 0, matching_seconds = 0, merge_seconds = 0;
  std::vector<SummaryField> solver = {};  ///< values that the solver reports
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

/// Merges the triangles of a patch in pairs by a perfect matching of minimum cost on the dual graph
/// (Blossom-Quad [remacle2012blossom]). The cost is 1 - eta, or `cost` unless it is null; reflex quads cost
/// more than convex ones.
///
/// An even boundary gives quads only. An odd one leaves one triangle in each odd component, whose absence
/// makes the rest cheapest. Vertices never move. New ones come last: from duplication, at the best place for
/// the worst quad, and from cut spanning sides. The number of quads is half the triangles, plus one for each
/// duplication and each cut spanning side.
///
/// The source derives a perfect matching from the theorem on cubic graphs without bridges. But a triangle on
/// the boundary has degree four, and the graph may have no such matching (18 points on a circle suffice).
/// Then every spanning side (an interior side between two boundary points) is cut in two, and a perfect
/// matching exists. The proof is own, by [tutte1947]. No triangle has two boundary sides, so the extra edges
/// link the triangles of each boundary loop to a cycle. Let S be a set of s1 triangles with a boundary side
/// and s3 without. Its removal leaves at least s1 + s3 + 2 odd components and cuts the cycles into r runs. A
/// component without boundary sides has at least three edges to S. The others have four a run: two along the
/// cycle, and two because other paths between boundary points have two edges. There are at most r of them. S
/// has 4 s1 + 3 s3 edge ends, and 2 (s1 - r) lead along a cycle to S itself. So 3 (s1 + s3 + 2 - r) + 4 r <=
/// 2 s1 + 3 s3 + 2 r, that is s1 + 6 <= r. But each run ends at another triangle of S, hence r <= s1. With an
/// odd number of triangles the bound allows one more odd component, which gives the leftover. Throws
/// std::logic_error if `solver` finds no perfect matching even so.
QuadPatch recombine(const TriPatch& tri, const MatchingSolver& solver, RecombineSummary* summary = nullptr,
                    long long extra_edge_cost = kExtraEdgeCost, const AddedCost& cost = nullptr);

/// Cuts every interior side between two boundary points at its middle, so that two triangles become four.
/// Returns the number of cuts. New points come last, and the number of triangles keeps its parity.
int split_spanning_sides(TriPatch& tri);

/// Options of greedy merging.
struct GreedyOptions {
  double least_eta = 0.1;     ///< least eta of a merged quad, above 0, up to 1
  bool longest_side = false;  ///< merge only across a side that is the longest of both triangles
  /// Limit, >= 0, of quads that change so that a leftover triangle gets a partner. It takes a triangle of a
  /// quad, and the other triangle finds a new one.
  int exchanges = 3;
};

/// Merges pairs of triangles by the eta of the quads, best first [borouchaki1998]; exchanges follow (own
/// guess). Triangles without a partner stay. Points do not change.
QuadPatch recombine_greedily(const TriPatch& tri, const GreedyOptions& options = {},
                             RecombineSummary* summary = nullptr);

/// Two triangles that an extra edge has matched: the first and the last of the fan at a boundary point. Both
/// begin with that point and are counterclockwise.
struct FanEnds {
  std::array<int, 3> first, last;
};

struct BoundaryRepairSummary {
  int pentagon_swaps = 0;
  int duplications = 0;
};

/// Turns each pair of fan ends into quads and adds them to the mesh, which has all other elements.
///
/// One quad (b, q, m, r) may lie between the ends (b, p, q) and (b, r, s). Then the pentagon swap can replace
/// all three by (b, p, q, m) and (b, m, r, s). Duplication of the boundary point b is always possible. A new
/// interior point b' replaces b in all elements between, and the ends become (b, p, q, b') and (b, b', r, s).
/// Duplication is chosen if its worst quad is clearly better. Each b' is placed where its worst element is
/// best [remacle2012blossom, section 4].
///
/// The source swaps whenever possible, and leaves the place of b' open.
BoundaryRepairSummary repair_fans(QuadPatch& mesh, const std::vector<FanEnds>& pairs);

}  // namespace delquad
