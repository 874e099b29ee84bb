#pragma once

#include <vector>

#include "geometry/surface/chart.h"

namespace delquad {

/// How far a flat chart is from a conformal one and from an isometry, weighted by area on the surface.
struct FlatQuality {
  double sigma_mean = 1, sigma_95 = 1, sigma_max = 1;  ///< ratio of singular values of triangles, >= 1
  double area_ratio = 1;                               ///< 99th over 1st percentile of the area scale
  double extreme_ratio = 1;  ///< the same of the 99.9th and .1th: small tips count, too
};

/// No triangle is flipped or flat, and the boundary neither crosses nor touches itself: exact.
bool is_one_to_one(const Chart& chart, const std::vector<Vec2>& flat);

/// The map must be one-to-one.
FlatQuality measure_flat(const Chart& chart, const std::vector<Vec2>& flat);

}  // namespace delquad
