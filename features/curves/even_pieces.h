#pragma once

#include <vector>

#include "geometry/planar/curve_pieces.h"

namespace delquad {

/// Changes numbers of edges by one, where it costs least, until every region has an even number of them.
/// Throws InputError where what was divided forbids that.
void make_counts_even(const PlanarModel& model, const Arrangement& arrangement, const FaceRegions& regions,
                      bool loops_are_apart, std::vector<CurvePiece>& pieces);

}  // namespace delquad
