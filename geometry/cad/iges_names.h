#pragma once

#include <IGESControl_Reader.hxx>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Names and colours of the faces that `reader` has transferred: those of all entities that hold them.
PartNames iges_names(const IGESControl_Reader& reader);

}  // namespace delquad::cad
