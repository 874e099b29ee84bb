// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/conformal_maps.h"
#include "geometry/surface/cut_planner.h"
#include "geometry/surface/flatten.h"

// This header flattens one chart, or tells how to cut it. Flattening uses it.

namespace delquad {

/// Holds the map of a chart, or how it is to be cut. It has neither for a triangle without area.
struct ChartOutcome {
  std::optional<ConformalMap> map;
  std::optional<CutPath> cut;
  bool divides = false;
  std::vector<char> parts = {};  ///< of each triangle, see plan_split
};

/// After so many rounds of cuts charts are parted along their triangles' edges.
inline constexpr int kMaxRounds = 40;

/// Maps a chart, or says how to cut it. `on_cut`: fine nodes on cuts; `tries`: cuts that were made because
/// its map distorted; `stuck`: its last cut could not be made.
ChartOutcome flatten_chart(const Chart& chart, const std::vector<CutEnd>& ends,
                           const std::vector<char>& on_cut, const FlattenOptions& options, double tolerance,
                           int tries, bool stuck);

/// Returns for each triangle 0 or 1, see plan_split().
std::vector<char> split_chart(const Chart& chart, const FlattenOptions& options);

}  // namespace delquad
