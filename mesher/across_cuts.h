#pragma once

#include <string>
#include <vector>

#include "mesher/runner.h"
#include "mesher/stages.h"

namespace delquad {

/// A given mesh in space is cut for its words, and nodes on cuts can move along these only. Runs `stages`,
/// which begin from quads, once more on `result`, the mesh that they made, with other cuts. What moves lies
/// on the facets that were given first. Returns the mesh, with the curves and regions of
/// `prepared`. Throws InputError where that cannot be.
Mesh run_across_cuts(const PreparedProblem& prepared, const std::vector<const Stage*>& stages,
                     const Mesh& result, StageLog& log);

}  // namespace delquad
