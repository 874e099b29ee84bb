#pragma once

#include "delquad/options.h"
#include "metrics/metrics.h"
namespace delquad {

/// A measure on a line of its own, to stdout; "-" where it is not defined.
void print_metric(const Metric& metric, const MeshMetrics& metrics);
/// Every measure but those of solvers.
void print_metrics(const MeshMetrics& metrics);

/// How long each step took, the times of all threads added up.
void print_seconds(const StepTimes& times);

}  // namespace delquad
