#pragma once

#include <vector>

#include "mesher/runner.h"

namespace delquad {

/// Whether faces were cut for a word with such stages, which begin from quads, so that it sees too little: Q
/// no cavity across a cut. Of a given mesh nodes on cuts can move along these only, whatever the stage.
bool are_cuts_in_the_way(const PreparedProblem& prepared, const std::vector<const Stage*>& of_quads);

/// Runs the stages once more with other cuts, in faces that have cuts. The mesh in `result`, which they made,
/// is replaced where that is better; it has no lines on cuts then. `left_out`: by region.
void run_across_cuts(const PreparedProblem& prepared, const std::vector<const Stage*>& of_quads,
                     const std::vector<char>& left_out, RunResult& result);

}  // namespace delquad
