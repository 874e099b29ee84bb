// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/conformal_maps.h"
#include "geometry/surface/cut_planner.h"
#include "geometry/surface/flatten.h"

// This header flattens one chart, or chooses its cut. Flattening uses it.

namespace delquad {

/// The map of a chart, or its cut. A triangle without area has neither.
struct ChartOutcome {
  std::optional<ConformalMap> map;
  std::optional<CutPath> cut;
  bool divides = false;
  std::vector<char> parts = {};  ///< part of each triangle, see plan_split()
};

/// Number of rounds of cuts after which charts are divided along edges of triangles.
inline constexpr int kMaxRounds = 40;

/// Returns the map of a chart, or its cut (own rules). `on_cut` marks fine nodes on cuts, `tries` counts
/// earlier cuts because of distortion, and `stuck` tells that the last cut failed. `tolerance` is a length,
/// for planar_map().
ChartOutcome flatten_chart(const Chart& chart, const std::vector<CutEnd>& ends,
                           const std::vector<char>& on_cut, const FlattenOptions& options, double tolerance,
                           int tries, bool stuck);

/// Returns 0 or 1 for each triangle, see plan_split(), beside elements if they are given.
std::vector<char> split_chart(const Chart& chart, const FlattenOptions& options);

}  // namespace delquad
