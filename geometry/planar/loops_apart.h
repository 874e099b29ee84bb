#pragma once

#include <optional>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/planar/check_lines.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Loops nearer to each other than this part of the model's diagonal touch: well above what is left of
/// coordinates with seven digits, below any gap that a mesh could fill.
inline constexpr double kTouch = 1e-6;

/// An edge of a loop: the part of a curve between two of its nodes.
struct LoopEdge {
  const Curve* shape;
  double t0, t1;
  Vec2 a, b;
  int loop, curve;
};

/// Throws InputError naming curves and place where two loops touch or cross: by their curves, whose edges may
/// well keep apart.
void check_loops_apart(const std::vector<LoopEdge>& edges, const BoundaryNames& names);

/// Two lines of loops that share more than a common end.
struct LineConflict {
  int loop[2];
  int line[2];  ///< the k-th line of a loop joins its nodes k and k + 1
};

struct LoopNesting {
  /// Of each loop the innermost loop around it, -1 if none. Meaningless after a conflict.
  std::vector<int> parent;
  std::optional<LineConflict> conflict;
};

/// Tells how closed polygons (indices into `points`, no node used twice, no points that coincide) lie in each
/// other, and whether any two lines cross, touch or overlap: see arrange().
LoopNesting nest_loops(const std::vector<Vec2>& points, const std::vector<std::vector<int>>& loops);

}  // namespace delquad
