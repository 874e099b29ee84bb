#pragma once

#include <array>
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
