// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/cut_path.h"

// This header chooses cuts of charts. Flattening uses it.

namespace delquad {

/// Quality of a fine node as the end of a cut.
enum class CutEnd : char { kAnywhere, kCurveStart, kCorner };

/// Returns the shortest of several paths between the two longest loops of a chart (own method). A harmonic
/// function falls along them, so that they meet both loops at right angles. They begin at corners of either
/// loop, if there are any. Paths just beside a corner inside the chart are avoided.
std::optional<CutPath> plan_seam(const Chart& chart, const std::vector<CutEnd>& ends);

/// Returns the sharp tips (of cones) inside the chart if they have most of its curvature; else none.
std::vector<int> sharp_tips(const Chart& chart);

/// Returns a path of the same kind between a tip and the boundary.
std::optional<CutPath> plan_tip_cut(const Chart& chart, int tip, const std::vector<CutEnd>& ends);

/// Returns a path that continues a cut from a blunt tip, where it ends, to the rest of the boundary. It gives
/// both parts half of the angle. Nothing without such a cut, or if other cuts bound the chart (`on_cut`, by
/// fine node).
std::optional<CutPath> plan_cut_through_tip(const Chart& chart, const std::vector<CutEnd>& ends,
                                            const std::vector<char>& on_cut);

/// Returns a level curve of fiedler_function() that is short for the areas that it separates (own choice). On
/// a chart with handles, curves that separate nothing are preferred.
std::optional<CutPath> plan_division(const Chart& chart);

/// Divides a chart along edges of its triangles, which is always possible. Returns 0 or 1 for each triangle,
/// for connected parts of similar extent. Empty for a single triangle.
std::vector<char> plan_split(const Chart& chart);

}  // namespace delquad
