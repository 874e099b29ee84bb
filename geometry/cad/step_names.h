// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <STEPControl_Reader.hxx>
#include <vector>

#include "geometry/cad/cad_shape.h"

// This header reads names and colors of STEP files. The reader of shapes uses it.

namespace delquad::cad {

/// Returns names and colors of the faces that `reader` has transferred, in the order of the file, and the
/// names of its edges. Faces get the names of their shells, solids and products, too. `is_ascii` tells that
/// the file has no other bytes, which the kernel would read as ISO 8859-1. `warnings` gets the assumed
/// encoding of other bytes.
PartNames step_names(const STEPControl_Reader& reader, bool is_ascii, std::vector<Warning>& warnings);

}  // namespace delquad::cad
