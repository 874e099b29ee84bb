// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/cad/cad_shape.h"

// This header triangulates CAD faces by the kernel. The reader of CAD uses it.

namespace delquad::cad {

/// The triangulation of one face, with nodes of its own.
struct FaceMesh {
  TopoDS_Face face;
  bool is_reversed = false;  ///< the triangles run clockwise in (u, v)
  std::vector<Vec3> points;
  std::vector<Vec2> uv;  ///< parameters of the points
  std::vector<std::array<int, 3>>
      triangles;  ///< counterclockwise about the face's normal as its shell sees it
};

/// Returns "face 12 (lid)", by its number and first name.
std::string face_title(int number, const std::vector<std::string>& names);

/// Triangulates the faces of a shape by the kernel, and reports each one to the run (activity.h). The
/// triangulation is stored in the shape. Neighbors have the same nodes along their edges. `deflection` > 0 is
/// a length, `angle` > 0 in radians.
void triangulate(const CadShape& cad, const TopTools_IndexedMapOfShape& faces, double deflection,
                 double angle);

/// Returns the triangulations of the faces, in the map's order. `why_not` gets for each face the reason why
/// its triangulation cannot be used, missing or without area, or an empty text. Faces with a reason have no
/// triangles.
std::vector<FaceMesh> face_meshes(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                                  std::vector<std::string>& why_not);

}  // namespace delquad::cad
