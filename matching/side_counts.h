#pragma once

#include <array>
#include <optional>
#include <vector>

namespace delquad {

/// A curve whose number of edges is to be chosen.
struct CountedCurve {
  double want;   ///< > 0
  int n;         ///< to begin with
  int least;     ///< at least 1
  bool is_free;  ///< else n stays
};

/// Curves around a face, each as often as the face lies beside it.
struct CountedFace {
  /// Of a mapped face, one after the other: opposite ones get the same number of edges. Else all curves are
  /// in the first, and the sum becomes even.
  std::array<std::vector<int>, 4> sides;
  bool is_mapped = false;
};

/// Changes numbers of edges, one by one, along the cheapest chains of faces, until every mapped face has
/// equal numbers on opposite sides and every other an even number around it; a change costs |log(n / want)|.
/// Returns a face for which there is none, or nothing. [A network of bidirected flow; not always the least
/// sum of costs.]
std::optional<int> balance_counts(std::vector<CountedCurve>& curves, const std::vector<CountedFace>& faces);

}  // namespace delquad
