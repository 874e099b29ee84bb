// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_ListOfShape.hxx>

#include <functional>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/cad_shape.h"

// This header repairs, sews and glues CAD shapes. Geometry uses it.

namespace delquad::cad {

/// Replaces the shape. `image` returns what a face or an edge became; its names move there.
void replace_shape(CadShape& cad, const TopoDS_Shape& shape,
                   const std::function<TopoDS_Shape(const TopoDS_Shape&)>& image);

/// Repairs invalid parts by the kernel, and sews free edges that coincide within `tolerance` (a length), of
/// two faces or more. Edges of faces that lie on each other are not sewn, and valid shapes stay. Warnings
/// tell all changes and remaining defects.
void heal_shape(CadShape& cad, double tolerance);

/// Removes each of some faces (numbers) whose edges lie on each other within their tolerances and the
/// tolerances of their ends. Sews these edges, with a warning. Returns false if there is none, or free edges
/// would be left.
bool drop_strips(CadShape& cad, const std::vector<int>& faces);

/// Reverses faces with a pole inside that the kernel's reader of STEP reversed. The reader moved their edges
/// by a period in (u, v) until they fit. Such a face covers the other part of the sphere, and goes around
/// more than once. It is reversed again if it then fits into a period; a warning tells the number.
void unwind_faces(CadShape& cad);

/// Returns the edges that bound no face as polylines, and the vertices without edges. Polylines are within
/// `deflection` (a length) of their edges. Edges without a curve and infinite edges are left out.
std::vector<LooseLine> loose_edges(const CadShape& cad, double deflection);

/// Removes edges and vertices inside of a single face, with which the kernel may fail to triangulate the
/// face.
void drop_inner_edges(CadShape& cad);

/// Makes bodies that touch or cut each other share faces, edges and vertices, by the kernel's general fuse.
/// Bodies are solids, closed shells, and all other faces one by one. Edges that end inside of a face are
/// embedded in it. Parts nearer than `tolerance` (a length) touch. Faces keep their names; common faces get
/// the names of both. Warnings tell the number of common faces, and faces that were cut. Throws InputError if
/// the kernel fails or a body is lost.
void glue_shape(CadShape& cad, double tolerance);

/// Returns the solids, then the shells of no solid, then the faces of no shell.
TopTools_ListOfShape bodies_of(const TopoDS_Shape& shape);

/// Returns a shape that a worker process read, healed and triangulated, since damaged files may crash or
/// block the kernel. Throws InputError as read_cad(), and Cancelled.
CadShape prepare_shape(const CadModel& model, const CadOptions& options);

/// Returns the same for a shape in memory.
CadShape prepare_shape(const CadShape& shape, const CadOptions& options);

/// Returns the model of a prepared shape; `source` names it in messages. Throws InputError as read_cad().
SurfaceModel model_of(const std::string& source, CadShape prepared, const CadOptions& options);

}  // namespace delquad::cad
