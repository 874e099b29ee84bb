#pragma once

#include <string>

#include "delquad/mesher.h"

namespace delquad {

/// Throws InputError, saying what is wrong and where, for a problem that makes no sense, whatever its model
/// is found to be: meshes that cannot be read (see require_readable()), models with nothing in them, numbers
/// out of range, and things that contradict each other.
void check_problem(const MeshProblem& problem);

// Parts of that, for those who read them from somewhere else. All throw InputError, beginning with `where`.

/// See SizeSpec.
void check_size_limits(double curvature, double min, double max, const std::string& where);
/// The value, when it is above 0 and at most 180.
double checked_feature_angle(double degrees, const std::string& where);
/// The value, when it is from 0 to 0.1. `what` is how messages call it.
double checked_weld_tolerance(double part, const std::string& where,
                              const std::string& what = "weld tolerance");

}  // namespace delquad
