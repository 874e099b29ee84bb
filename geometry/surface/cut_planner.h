// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface/cut_path.h"

// This header chooses cuts of charts. Flattening uses it.

namespace delquad {

/// How good a place each fine node is for a cut to end.
enum class CutEnd : char { kAnywhere, kCurveStart, kCorner };

/// Returns a path between the two longest loops of a chart, along which a harmonic function falls from one to
/// the other. It meets both at right angles. It begins at a corner of either where there is one, and the
/// shortest is taken.
std::optional<CutPath> plan_seam(const Chart& chart, const std::vector<CutEnd>& ends);

/// Returns the sharp tips (of cones) inside the chart, when they hold most of its curvature; none when they
/// do not.
std::vector<int> sharp_tips(const Chart& chart);

/// Returns a path between a tip and the boundary, of the same kind.
std::optional<CutPath> plan_tip_cut(const Chart& chart, int tip, const std::vector<CutEnd>& ends);

/// Plans a cut through a tip. Where a cut ends at a blunt tip, a path that goes on from there to the rest of
/// the boundary. It leaves both parts half of the angle. None where no cut does, or other cuts bound the
/// chart (`on_cut`: fine nodes).
std::optional<CutPath> plan_cut_through_tip(const Chart& chart, const std::vector<CutEnd>& ends,
                                            const std::vector<char>& on_cut);

/// Returns a level curve of the chart's slowest vibration, short for the areas that it separates. On a chart
/// with handles, it is rather one that separates nothing.
std::optional<CutPath> plan_division(const Chart& chart);

/// Parts a chart along edges of its triangles, which is always possible. Returns 0 or 1 for each triangle,
/// both parts connected and of about the same extent. Empty for a single triangle.
std::vector<char> plan_split(const Chart& chart);

}  // namespace delquad
