#pragma once

#include <vector>

#include "delquad/metrics.h"
#include "geometry/surface/chart.h"

namespace delquad {

/// No triangle is flipped or flat, and the boundary neither crosses nor touches itself: exact.
bool is_one_to_one(const Chart& chart, const std::vector<Vec2>& flat);

/// The map must be one-to-one.
FlatQuality measure_flat(const Chart& chart, const std::vector<Vec2>& flat);

}  // namespace delquad
