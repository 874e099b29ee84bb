#pragma once

#include <string>
#include <vector>

#include "delquad/model.h"

namespace delquad {

/// The nodes of a curve that is cut into pieces of these lengths: of each piece the lengths from its
/// beginning to its nodes, ascending, both ends included. Ends of pieces are nodes already, and count as the
/// nearest of the wanted ones. Throws InputError for fewer edges than pieces; `label` is the curve's.
std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label);

}  // namespace delquad
