#pragma once

#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"

namespace delquad {

/// The nodes of a curve that is cut into pieces of these lengths: of each piece the lengths from its
/// beginning to its nodes, ascending, both ends included. Ends of pieces are nodes already, and count as the
/// nearest of the wanted ones. Throws InputError for fewer edges than pieces; `label` is the curve's.
std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label);

/// Whether a division means that curve. `tag`: its number in files.
bool names_curve(const CurveDivision& division, const std::vector<std::string>& names, int tag);

/// What to throw for a division that means no curve; `known`: the curves' names.
InputError no_such_curve(const CurveDivision& division, const std::vector<std::string>& known);

}  // namespace delquad
