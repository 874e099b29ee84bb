// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/matching/matching.h"

// This header chooses numbers of edges on curves. Layouts, grids and boundaries of patches use it.

namespace delquad {

/// Numbers of edges without an upper limit.
inline constexpr int kAnyNumber = std::numeric_limits<int>::max();

/// A curve whose number n of edges may change. It costs n |log(n / ideal)| (weight + 8 |log(n / ideal)|), and
/// 20 for each edge beyond `most`.
struct AgreeingCurve {
  double ideal;              ///< edges, > 0
  int least;                 ///< at least 1
  bool is_free;              ///< otherwise its number is fixed
  double weight;             ///< >= 0
  std::vector<int> patches;  ///< adjacent patches; a seam has its patch twice
  int most = kAnyNumber;
};

/// A signed sum of numbers of edges. Unless it is zero, rows of quads end in a patch, at a cost of
/// price_of_pair + price * |sum|.
struct ClosureSum {
  int patch;
  std::vector<std::pair<int, int>> terms;  ///< curve and its signed factor
  double price_of_pair = 0, price = 0;
  int at_least = 0;  ///< > 0: least value in place of zero; the sum costs by its deficit
};

/// Lowers the sum of all costs by two kinds of changes. A change by one follows a closed chain of curves and
/// patches, so each patch keeps its parity (the outside is one more patch). A change by two follows an open
/// chain. A search from a curve finds the cheapest ones, as in bidirected flow [heistermann2023], and several
/// in a row may bring a sum to zero. The search is own. The result is a local minimum, or unfinished if all
/// `steps` are spent: one for each examined curve. A search examines at most `most_looks` patches. `counts`
/// has the numbers by curve, each at least 1, and is changed.
void agree_counts(const std::vector<AgreeingCurve>& curves, int n_patches,
                  const std::vector<ClosureSum>& sums, Budget& steps, std::vector<int>& counts,
                  int most_looks = 2000);

/// Graph with costs >= 0 on its edges; parallel edges and self-loops are allowed.
struct WeightedGraph {
  struct Edge {
    int a, b;
    double cost;
  };
  int n_nodes = 0;
  std::vector<Edge> edges;
};

struct TJoin {
  std::vector<int> edges;      ///< chosen edges, ascending
  std::vector<int> unmatched;  ///< a terminal of each component with an odd number of them, left alone
};

/// Returns the cheapest set of edges in which exactly the terminals have odd degree [edmonds1973]. Shortest
/// paths between terminals are matched at minimum cost, to about nine digits. `terminals` are distinct nodes.
TJoin minimum_t_join(const WeightedGraph& graph, const std::vector<int>& terminals,
                     const MatchingSolver& solver);

/// A curve whose number of edges is chosen.
struct CountedCurve {
  double ideal;  ///< > 0
  int n;         ///< initial number
  int least;     ///< at least 1
  bool is_free;  ///< otherwise n is fixed
};

/// Curves around a face, repeated if the face lies on both sides.
struct CountedFace {
  /// Sides of a mapped face in order. If there are four, opposite ones get equal numbers of edges. If there
  /// are three, the sum becomes even, and each is less than the sum of the others. For another face, the
  /// first has all curves, and the sum becomes even.
  std::array<std::vector<int>, 4> sides;
  int n_sides = 0;  ///< 4 or 3 for a mapped face, else 0
};

/// A face whose condition cannot be met.
struct UnbalancedFace {
  int face;
  std::vector<int> fixed;  ///< fixed curves at it and along connected mapped faces
};

/// Changes numbers of edges until all faces meet their conditions. Changes by one follow the cheapest chains
/// of faces; each costs |log(n / ideal)|. Then curves of mapped faces change by one, with the cheapest chains
/// that compensate, as long as the sum of log^2(n / ideal) falls. It is a network of bidirected flow
/// [heistermann2023] with an own search; the sum is usually the least, but not always. Returns the faces
/// without a solution.
std::vector<UnbalancedFace> balance_counts(std::vector<CountedCurve>& curves,
                                           const std::vector<CountedFace>& faces);

}  // namespace delquad
