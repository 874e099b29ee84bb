#pragma once

#include "algorithms/recombination/recombine.h"
#include "algorithms/recombination/treatment.h"

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

/// What follows on merging there [borouchaki1998], as far as is known: edges between quads are swapped where
/// that brings the degrees of their vertices nearer to 4 (the boundary's: to what its angle asks for), inner
/// vertices of two elements are taken out, and vertices go towards the mean of the points that would be best
/// for each element around, weighted by 1/delta'^2: the corner that makes the diagonal opposite a square's,
/// or the side of a triangle one of an equilateral. A move is kept when the worst element around gets better,
/// an edit when it gets no worse than that or half as good as a square (in the sine of the least corner).
QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size,
                           const TreatmentOptions& options = {}, TreatmentSummary* summary = nullptr);

}  // namespace delquad
