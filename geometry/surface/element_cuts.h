// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/cut_path.h"

// This header cuts charts of a given mesh beside its elements. Flattening uses it.

namespace delquad {

/// Elements that consist of a chart's triangles. The chart is cut only along sides between them.
struct ChartElements {
  std::vector<int> element;        ///< element of each triangle; triangles of one element are connected
  std::vector<char> avoided = {};  ///< whether cuts should avoid each vertex; empty: none
};

/// Returns the shortest path along sides inside the chart from a vertex that is marked in `from` to one in
/// `to`. It meets the boundary at most with its ends.
std::optional<CutPath> path_beside_elements(const Chart& chart, const ChartElements& elements,
                                            const std::vector<char>& from, const std::vector<char>& to);

/// Divides a chart by level curves of the Fiedler function of its elements, if their border is short for
/// their areas (own choice). Returns 0 or 1 for each triangle. If all elements are triangles, an even number
/// of them, one may move so that both parts are even. Empty for a single element.
std::vector<char> plan_division(const Chart& chart, const ChartElements& elements);

}  // namespace delquad
