#pragma once

#include <IMeshTools_Parameters.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

namespace delquad::cad {

/// The kernel's triangulation of a shape, which tells what faces (numbers in the map) it is at (see
/// activity.h) and does not begin those in `skipped` (ascending).
void mesh_faces(const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& faces,
                const IMeshTools_Parameters& parameters, const std::vector<int>& skipped);

}  // namespace delquad::cad
