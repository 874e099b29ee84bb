// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_ListOfShape.hxx>

#include <functional>
#include <vector>

#include "delquad/model.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/cad_shape.h"

// This header repairs, sews and glues CAD shapes. Geometry uses it.

namespace delquad::cad {

/// Puts `shape` in the place of the CAD's; `image` tells what has become of a face or an edge, which hands
/// its names on.
void replace_shape(CadShape& cad, const TopoDS_Shape& shape,
                   const std::function<TopoDS_Shape(const TopoDS_Shape&)>& image);

/// Repairs what the kernel finds invalid, and sews free edges that coincide within `tolerance` (a length), of
/// however many faces. Edges of faces that lie on each other are not sewn, and valid shapes stay as they are.
/// The warnings say what was done and what remains wrong.
void heal_shape(CadShape& cad, double tolerance);

/// Takes out, among some faces (numbers), each face whose edges lie on each other within their and their
/// ends' tolerances. Sews these edges, and says so in a warning. False: there is none, or that leaves free
/// edges.
bool drop_strips(CadShape& cad, const std::vector<int>& faces);

/// Turns faces back that the kernel's reader of STEP turned over, because they have a pole inside. It moves
/// their edges by a period in (u, v) until they fit. The face then is the other part of the sphere and more,
/// going around more than once. Such faces are turned back, where that makes them fit into a period; a
/// warning tells how many.
void unwind_faces(CadShape& cad);

/// Returns the edges that bound no face, both inside of faces and beside all, as polylines, and the vertices
/// that no edge has. Polylines are no further than `deflection` (a length) from their edges. Edges without a
/// curve and infinite ones are left to others.
std::vector<LooseLine> loose_edges(const CadShape& cad, double deflection);

/// Takes edges and vertices inside of one face alone out of it: the kernel fails to triangulate some faces
/// with them.
void drop_inner_edges(CadShape& cad);

/// Makes bodies that touch or cut each other share faces, edges and vertices there, by the kernel's general
/// fuse. Bodies are solids, closed shells, and all other faces one by one. Edges that end inside of a face
/// stand in it. Parts nearer than `tolerance` (a length) touch. Names go with the faces; common faces get the
/// names of both. Warnings tell how many faces are common, and which were cut into parts. Throws InputError
/// if the kernel cannot do it or a body gets lost.
void glue_shape(CadShape& cad, double tolerance);

/// Returns the solids, then the shells outside of them, then the faces outside of these.
TopTools_ListOfShape bodies_of(const TopoDS_Shape& shape);

/// Reads, heals and triangulates a shape in a worker process: on damaged files the kernel follows broken
/// references or runs in circles. Throws InputError and Cancelled.
CadShape prepare_shape(const CadModel& model, const CadOptions& options);

/// Returns the same for a shape as it was made.
CadShape prepare_shape(const CadShape& shape, const CadOptions& options);

}  // namespace delquad::cad
