#pragma once

#include <string>
#include <vector>

#include "mesher/runner.h"

namespace delquad {

/// Whether what was made of a given mesh is worse: not sound where that was, or else with a worse worst angle
/// (eta), a shorter shortest edge (in sizes) or a larger aspect, with a number of quads that differs by more
/// than a tenth, or with none of eta mean, eta worst and d4 better and one of them worse.
bool is_worse(const RunResult& after, const RunResult& before);

/// Where `result`, which the `stages` made of the quads that were `given`, is worse than these, it becomes
/// what fewer of the stages make, if that is not, or else the given mesh. A warning says so. `left_out`: by
/// region.
void keep_better(const PreparedProblem& prepared, const std::string& label,
                 const std::vector<PatchMesh>& given, const std::vector<const Stage*>& stages,
                 const std::vector<char>& left_out, RunResult& result);

}  // namespace delquad
