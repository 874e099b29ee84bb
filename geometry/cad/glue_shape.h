#pragma once

#include <TopTools_ListOfShape.hxx>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Makes bodies (solids, closed shells, and all other faces one by one) that touch or cut each other share
/// faces, edges and vertices there: the kernel's general fuse. Edges that end inside of a face stand in it.
/// What is nearer than `tolerance` (a length) touches. Names go with the faces; common ones get those of
/// both. Warnings tell how many faces are common, and which were cut into parts. Throws InputError when the
/// kernel cannot do it or a body gets lost.
void glue_shape(CadShape& cad, double tolerance);

/// The solids, then the shells outside of them, then the faces outside of these.
TopTools_ListOfShape bodies_of(const TopoDS_Shape& shape);

}  // namespace delquad::cad
