#pragma once

#include <deque>
#include <functional>

#include "delquad/metrics.h"

namespace delquad {

/// The measures from outside, with their keys.
struct OwnMetric {
  std::string key;
  std::function<double(const MetricInput&)> measure;
};
const std::deque<OwnMetric>& own_metrics();

}  // namespace delquad
