#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/planar/curve_span.h"

namespace delquad {

/// A point that stands alone in a region becomes a node because an edge leaves it. The ends of these edges,
/// one for each of `points`: about as long as `sizes`, shorter where curves or other points are near, and
/// away from what is next. Throws InputError, naming the point, where there is no room for a thousandth of
/// its size.
std::vector<std::array<Vec2, 2>> whisker_ends(const std::vector<CurveSpan>& curves,
                                              const std::vector<Vec2>& points,
                                              const std::vector<double>& sizes,
                                              const std::vector<std::string>& labels);

}  // namespace delquad
