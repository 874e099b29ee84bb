#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/cut_path.h"

namespace delquad {

/// What a chart's triangles make up: it is cut along sides between these only.
struct ChartElements {
  std::vector<int> element;        ///< of each triangle; those of one element hang together
  std::vector<char> avoided = {};  ///< of each vertex, whether cuts should go around it
};

/// The shortest path along sides inside the chart from a vertex that is marked in `from` to one in `to`,
/// which meets the boundary at most with its ends.
std::optional<CutPath> path_beside_elements(const Chart& chart, const ChartElements& elements,
                                            const std::vector<char>& from, const std::vector<char>& to);

/// Parts a chart where the way between both parts is short for their areas, by level curves of its slowest
/// vibration: for each triangle 0 or 1. Of a chart of triangles alone with an even number of them both parts
/// have an even number where one triangle can make them so. Empty for a single element.
std::vector<char> plan_division(const Chart& chart, const ChartElements& elements);

}  // namespace delquad
