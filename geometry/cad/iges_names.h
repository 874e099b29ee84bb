#pragma once

#include <IGESControl_Reader.hxx>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Names and colours of the faces that `reader` has transferred: those of all entities that hold them.
/// `warnings` receives what bytes beyond ASCII were taken for.
PartNames iges_names(const IGESControl_Reader& reader, std::vector<Warning>& warnings);

}  // namespace delquad::cad
