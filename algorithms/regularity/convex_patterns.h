#pragma once

#include <optional>

#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"

namespace delquad {

/// Of a row of edges between two places: (edges) * log^2(length / wanted length).
double strain_of(Vec2 a, Vec2 b, int edges, double delta);

/// Of the patterns without cuts of an outline without concave vertices the one with the least strain.
std::optional<Pattern> best_convex(const Outline& outline, const PolygonSides& sides);

}  // namespace delquad
