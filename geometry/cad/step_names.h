#pragma once

#include <STEPControl_Reader.hxx>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Names and colours of the faces that `reader` has transferred, in the order of the file: those of faces,
/// shells, solids and products; and the names of its edges.
/// `is_ascii`: the file has no other bytes, which the kernel would have taken for ISO 8859-1. `warnings`
/// receives what other bytes were taken for.
PartNames step_names(const STEPControl_Reader& reader, bool is_ascii, std::vector<Warning>& warnings);

}  // namespace delquad::cad
