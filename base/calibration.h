// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header scales sizes to reach a number of quads. The pipeline and comparisons with peers use it.

namespace delquad {

/// Returns the number of quads; a triangle counts half, by its area.
double count_of_quads(const Mesh& mesh);

/// Best run of a calibration.
struct Calibration {
  double scale = 1;                             ///< factor of the size, from 1/4 to 4
  double quads = 0;                             ///< number of quads at this scale; 0 if the first run failed
  int runs = 0;                                 ///< number of runs
  std::vector<std::vector<double>> tried = {};  ///< scale and number of quads of each successful run
};

/// Tolerance, as a share of the wanted number, and limit of runs, failed ones included.
struct CalibrationLimits {
  double tolerance;
  int most_runs;
};

/// Finds a scale of sizes at which `quads_at` returns `wanted` > 0 within the tolerance. It starts at 1 and
/// takes regula falsi on logarithms, or the secant without a bracket. The limits of its steps are own. It
/// ends, with the closest scale, at the limit of runs, and if `quads_at` returns nothing. It also ends if the
/// number does not follow the size or jumps over `wanted`.
Calibration calibrate_scale(double wanted, const CalibrationLimits& limits,
                            const std::function<std::optional<double>(double scale)>& quads_at);

}  // namespace delquad
