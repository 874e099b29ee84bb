#pragma once

#include "mesher/prepare.h"
#include "mesher/stages.h"
#include "metrics/metrics.h"

namespace delquad {

/// Every measure on a line of its own, to stdout; "-" where it is not defined.
void print_metrics(const MeshMetrics& metrics);

/// How long each step took, the times of all threads added up.
void print_seconds(const PreparedProblem& prepared, const StageLog& log);

}  // namespace delquad
