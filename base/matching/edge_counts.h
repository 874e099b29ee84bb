#pragma once

#include <array>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/matching/matching.h"

namespace delquad {

/// A curve whose number n of edges may change; they cost n * |log(n / want)| * (weight + 8 |log(n / want)|).
struct AgreeingCurve {
  double want;               ///< edges, > 0
  int least;                 ///< at least 1
  bool is_free;              ///< else its number stays
  double weight;             ///< >= 0
  std::vector<int> patches;  ///< that it bounds; a seam names its patch twice
};

/// Numbers of edges with signs. If they do not add up to zero, rows of quads have to end in a patch, which
/// costs price_of_pair + price * |sum|.
struct ClosureSum {
  int patch;
  std::vector<std::pair<int, int>> terms;  ///< curve and how often it counts, with its sign
  double price_of_pair = 0, price = 0;
  int at_least = 0;  ///< > 0: it is to be so much or more, in place of zero, and costs by what it lacks
};

/// Lowers the sum of all costs by changes of two kinds: by one, along a closed chain of curves and patches,
/// so that each patch keeps its parity (what lies beyond the outline is one patch more); by two, along an
/// open one. Both are the cheapest that a search finds from a curve on [as in bidirected flow]; several in a
/// row may bring a sum to zero. The result is a local minimum, or as near to one as came out when all `steps`
/// were spent: one for each curve that the searches looked at. A search looks at `most_looks` patches. The
/// same input gives the same numbers.
void agree_counts(const std::vector<AgreeingCurve>& curves, int n_patches,
                  const std::vector<ClosureSum>& sums, Budget& steps, std::vector<int>& counts,
                  int most_looks = 2000);

/// A graph with costs >= 0 on its edges; parallel edges and self-loops are allowed.
struct WeightedGraph {
  struct Edge {
    int a, b;
    double cost;
  };
  int n_nodes = 0;
  std::vector<Edge> edges;
};

struct TJoin {
  std::vector<int> edges;      ///< chosen, ascending
  std::vector<int> unmatched;  ///< a terminal of each component that has an odd number of them; left as it is
};

/// The cheapest set of edges in which exactly the terminals have odd degree [edmonds1973]: shortest paths
/// between terminals, matched at minimum cost. `terminals` are distinct nodes.
TJoin minimum_t_join(const WeightedGraph& graph, const std::vector<int>& terminals,
                     const MatchingSolver& solver);

/// A curve whose number of edges is to be chosen.
struct CountedCurve {
  double want;   ///< > 0
  int n;         ///< to begin with
  int least;     ///< at least 1
  bool is_free;  ///< else n stays
};

/// Curves around a face, each as often as the face lies beside it.
struct CountedFace {
  /// Of a mapped face, one after the other: of four sides, opposite ones get the same number of edges; of
  /// three, the sum becomes even and each less than that of the two others together. Else all curves are in
  /// the first, and the sum becomes even.
  std::array<std::vector<int>, 4> sides;
  int n_sides = 0;  ///< 4 or 3 of a mapped face, else 0
};

/// A face whose condition cannot be met.
struct UnbalancedFace {
  int face;
  std::vector<int> fixed;  ///< curves that are not free, at it and along the mapped faces from there on
};

/// Changes numbers of edges until all faces have what they need. First one by one along the cheapest chains
/// of faces, where a change costs |log(n / want)|; then, as long as that lowers the sum of log^2(n / want),
/// each curve of a mapped face by one, together with the cheapest chains that make up for it. [A network of
/// bidirected flow; the sum is mostly the least there is, not always.] Returns the
/// faces for which there is nothing.
std::vector<UnbalancedFace> balance_counts(std::vector<CountedCurve>& curves,
                                           const std::vector<CountedFace>& faces);

}  // namespace delquad
