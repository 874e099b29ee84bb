#pragma once

#include "mesher/stages.h"
#include "metrics/metrics.h"
#include "patches/prepared.h"

namespace delquad {

/// A measure on a line of its own, to stdout; "-" where it is not defined.
void print_metric(const Metric& metric, const MeshMetrics& metrics);
/// Every measure but those of solvers.
void print_metrics(const MeshMetrics& metrics);

/// How long each step took, the times of all threads added up.
void print_seconds(const PreparedProblem& prepared, const StageLog& log);

}  // namespace delquad
