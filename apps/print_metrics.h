#pragma once

#include "metrics/metrics.h"
#include "pipeline/prepare.h"
#include "pipeline/stages.h"

namespace delquad {

/// Every measure on a line of its own, to stdout; "-" where it is not defined.
void print_metrics(const MeshMetrics& metrics);

/// How long each step took, the times of all threads added up.
void print_seconds(const PreparedCase& prepared, const StageLog& log);

}  // namespace delquad
