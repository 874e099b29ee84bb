#pragma once

#include <STEPControl_Reader.hxx>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Names and colours of the faces that `reader` has transferred, in the order of the file: those of faces,
/// shells, solids and products; and the names of its edges.
PartNames step_names(const STEPControl_Reader& reader);

}  // namespace delquad::cad
