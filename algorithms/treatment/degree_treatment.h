#pragma once

#include "algorithms/treatment/treatment.h"

namespace delquad {

/// What follows on greedy merging [borouchaki1998], as far as is known: edges between quads are swapped where
/// that brings the degrees of their vertices nearer to 4 (the boundary's: to what its angle asks for), inner
/// vertices of two elements are taken out, and vertices go towards the mean of the points that would be best
/// for each element around, weighted by 1/delta'^2: the corner that makes the diagonal opposite a square's,
/// or the side of a triangle one of an equilateral. A move is kept when the worst element around gets better,
/// an edit when it gets no worse than that or half as good as a square (in the sine of the least corner).
QuadPatch treat_by_degrees(const QuadPatch& mesh, const ParametricSize& size,
                           const TreatmentOptions& options = {}, TreatmentSummary* summary = nullptr);

}  // namespace delquad
