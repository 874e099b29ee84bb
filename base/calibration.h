#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Quads, and a triangle as half a quad, whose area it has.
double count_of_quads(const Mesh& mesh);

/// How close a mesher came to a number of quads by changing its size.
struct Calibration {
  double scale = 1;                             ///< by which the size is multiplied
  double quads = 0;                             ///< its number then
  int runs = 0;                                 ///< how often it was run
  std::vector<std::vector<double>> tried = {};  ///< scale and number of each run that gave one
};

/// How close is close enough, as a part of the wanted number, and how often a mesher is run to get there.
struct CalibrationLimits {
  double tolerance;
  int most_runs;
};

/// Looks for the scale of the sizes at which `quads_at` gives `wanted` within the tolerance, beginning with
/// 1: by regula falsi on the logarithms, and by the secant before there is a bracket. Ends, with the closest,
/// after the most runs, when the number does not follow the size or jumps over `wanted`, and when `quads_at`
/// gives nothing.
Calibration calibrate_scale(double wanted, const CalibrationLimits& limits,
                            const std::function<std::optional<double>(double scale)>& quads_at);

}  // namespace delquad
