#pragma once

#include <optional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

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
