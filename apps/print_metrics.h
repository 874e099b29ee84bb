#pragma once

#include "metrics/metrics.h"

namespace delquad {

/// Every measure on a line of its own, to stdout; "-" where it is not defined.
void print_metrics(const MeshMetrics& metrics);

}  // namespace delquad
