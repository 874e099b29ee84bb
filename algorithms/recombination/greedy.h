#pragma once

#include "algorithms/recombination/recombine.h"

namespace delquad {

/// Which pairs of triangles may become quads.
struct GreedyOptions {
  double least_eta = 0.1;     ///< of a merged quad, above 0
  bool longest_side = false;  ///< only across a side that is the longest of both triangles
  /// A triangle without partner may take one from a quad, whose other triangle finds another; at most so many
  /// quads are made anew for it.
  int exchanges = 3;
};

/// Merges pairs of triangles in the order of the quads' eta, best first, each triangle once; then by
/// exchanges. What finds no partner stays a triangle. Points are kept. [borouchaki1998]
QuadPatch recombine_greedily(const TriPatch& tri, const GreedyOptions& options = {},
                             RecombineSummary* summary = nullptr);

}  // namespace delquad
