#pragma once

#include "mesher/runner.h"

namespace delquad {

/// Whether what was made of a given mesh is worse: not sound where that was, or else with a worse worst angle
/// (eta), a shorter shortest edge (in sizes) or a larger aspect, with a number of quads that differs by more
/// than a tenth, or with none of eta mean, eta worst and d4 better and one of them worse.
bool is_worse(const RunResult& after, const RunResult& before);

/// Whether it is not worse, and the sum of eta mean, eta worst and the share of regular vertices is larger.
bool is_better(const RunResult& after, const RunResult& before);

/// Whether there are fewer irregular vertices, and edges are as near to their size.
bool is_more_regular(const RunResult& after, const RunResult& before);

/// Whether the worst eta is above this or what it was.
bool keeps_worst_eta(double eta, const RunResult& after, const RunResult& before);

/// Takes another mesh and what is measured of it.
void take_mesh(RunResult&& from, RunResult& result);

}  // namespace delquad
