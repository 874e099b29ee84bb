// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/cut_path.h"

// This header cuts charts of a given mesh beside its elements. Flattening uses it.

namespace delquad {

/// Elements that consist of a chart's triangles. The chart is cut only along sides between them.
struct ChartElements {
  std::vector<int> element;        ///< of each triangle; triangles of one element hang together
  std::vector<char> avoided = {};  ///< of each vertex, whether cuts should go around it
};

/// Returns the shortest path along sides inside the chart from a vertex that is marked in `from` to one in
/// `to`. It meets the boundary at most with its ends.
std::optional<CutPath> path_beside_elements(const Chart& chart, const ChartElements& elements,
                                            const std::vector<char>& from, const std::vector<char>& to);

/// Divides a chart if the way between both parts is short for their areas, by level curves of its slowest
/// vibration. Returns 0 or 1 for each triangle. If a chart has an even number of triangles and nothing else,
/// both parts have an even number if one triangle can achieve it. Empty for a single element.
std::vector<char> plan_division(const Chart& chart, const ChartElements& elements);

}  // namespace delquad
