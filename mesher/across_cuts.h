#pragma once

#include <vector>

#include "mesher/finish_steps.h"

namespace delquad {

/// Whether faces were cut for a word with such stages, which begin from quads, so that it sees too little:
/// those that fill cavities, none across a cut. Of a given mesh nodes on cuts can move along these only,
/// whatever the stage.
bool are_cuts_in_the_way(const PreparedProblem& prepared, const std::vector<const Stage*>& of_quads);

/// Runs the stages that begin from quads once more with other cuts, in faces that have cuts. The mesh that
/// they made is replaced where that is better; it has no lines on cuts then. Returns whether it was.
bool run_across_cuts(Finishing& on);

}  // namespace delquad
