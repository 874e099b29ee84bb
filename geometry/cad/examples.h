#pragma once

#include <string>
#include <string_view>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Returns the file of an example in examples/, or nothing. It has the number of faces, a line of each face's
/// name, and the shape as a binary BREP file.
std::string_view example_data(std::string_view name);

/// Returns an example. As in the product of a STEP file, its faces have its name first; lengths are in mm.
CadShape make_product(const std::string& name);

}  // namespace delquad::cad
