#pragma once

#include <functional>
#include <vector>

#include "base/counters.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"

namespace delquad {

/// What refine_unsound() did.
struct RefinementSummary {
  int rounds = 0;  ///< how often the problem was meshed anew
  int spots = 0;   ///< places around which the size is smaller
};

template <>
struct Counters<RefinementSummary> {
  using S = RefinementSummary;
  static constexpr const char* step = "refine_unsound";
  static constexpr auto all = std::tuple{counter("rounds", &S::rounds), counter("spots", &S::spots)};
};

/// prepare_problem() of the same problem.
using PrepareAnew = std::function<PreparedProblem(const Refinement&)>;

/// Where the mesh of a surface is not sound, the size is too large for what is there: halves it around these
/// places and meshes anew, as long as there get fewer such places, but no more quads than a budget allows;
/// where that does not help, sharp edges there become features. `prepared` and `result` become those of the
/// best mesh, with a warning and the time of all tries; if that is not sound, a warning says why there are no
/// more, and where the problem says keep_going, faces with such places are left out if others remain.
void refine_unsound(const PrepareAnew& prepare_anew, const Word& word, PreparedProblem& prepared,
                    RunResult& result);

}  // namespace delquad
