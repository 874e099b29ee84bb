#pragma once

#include <utility>
#include <vector>

#include "base/budget.h"

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
};

/// Lowers the sum of all costs by changes of two kinds: by one, along a closed chain of curves and patches,
/// so that each patch keeps its parity (what lies beyond the outline is one patch more); by two, along an
/// open one. Both are the cheapest that a search finds from a curve on [as in bidirected flow]; several in a
/// row may bring a sum to zero. The result is a local minimum, or as near to one as came out when all `steps`
/// were spent: one for each curve that the searches looked at. The same input gives the same numbers.
void agree_counts(const std::vector<AgreeingCurve>& curves, int n_patches,
                  const std::vector<ClosureSum>& sums, Budget& steps, std::vector<int>& counts);

}  // namespace delquad
