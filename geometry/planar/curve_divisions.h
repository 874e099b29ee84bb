#pragma once

#include <vector>

#include "delquad/model.h"

namespace delquad {

/// Where the edges of a division end, in parts of the curve's length: n + 1 numbers from 0 to 1.
std::vector<double> division_ends(const CurveDivision& division);

}  // namespace delquad
