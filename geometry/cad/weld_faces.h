// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>

#include <array>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/cad/tessellate.h"
#include "geometry/surface/surface_model.h"

// This header joins the triangulations of CAD faces. Geometry uses it.

namespace delquad::cad {

/// An edge that is a curve of the model.
struct CurveMesh {
  TopoDS_Edge edge;
  std::vector<double> parameters;  ///< parameters of the points of its lines
};

/// A point added inside of a face, on the middle of a side.
struct PointInside {
  int point, face;  ///< index of the point, and of the region
};

struct WeldedFaces {
  Mesh mesh;  ///< regions are the faces, without names
  std::vector<CurveMesh> curves;
  std::vector<int> corners;             ///< points that must be nodes
  std::vector<EmbeddedCurve> embedded;  ///< curves inside of faces, by curve
  std::vector<PointInside> inside;      ///< added points, not yet on the surface: see split_duplicate_sides()
  std::vector<int> bad_faces;           ///< triangles miss the boundary by more than `gap`, or are no surface
};

/// Returns the faces with one node for each point of an edge, a vertex or a degenerate edge (own method).
/// Nodes of an edge correspond by their order along it, as on both sides of a seam. Degenerate edges and
/// seams of one face are no curves, nor are edges of faces without triangles only. `gap` is a length, see
/// repair_face(). Throws InputError if faces have different numbers of nodes on an edge.
WeldedFaces weld_faces(const std::vector<FaceMesh>& faces, const TopTools_IndexedMapOfShape& edges,
                       double gap);

/// Does the same, but faces with unusable triangles lose these, with the reason in `why_not`.
WeldedFaces weld_usable(std::vector<FaceMesh>& meshes, const TopTools_IndexedMapOfShape& edges, double gap,
                        std::vector<std::string>& why_not);

/// Makes the triangles of a face end at its boundary (own method). `boundary` has the sides of the face's
/// edges, each in the direction of its triangle; the two sides of a seam cancel. At cusps and poles the
/// kernel leaves gaps, and pairs of folded triangles. Gaps are filled with triangles of least area, pairs are
/// removed. Returns the largest ratio of a gap's area to its perimeter, a length.
double repair_face(const std::vector<Vec3>& points, const std::vector<std::array<int, 2>>& boundary,
                   std::vector<std::array<int, 3>>& triangles);

/// Splits inner sides of faces whose nodes another face also joins by a side. Both sides lie on different
/// paths over the surface, so each inner one gets a node on its middle. Then an edge of the mesh has two
/// triangles. `boundary` has the sides (lower node first) on edges of each face, sorted. Returns the new
/// points.
std::vector<PointInside> split_duplicate_sides(Mesh& mesh,
                                               const std::vector<std::vector<std::array<int, 2>>>& boundary);

/// Returns whether no side belongs to more than two of the triangles.
bool is_manifold(const std::vector<std::array<int, 3>>& triangles);

}  // namespace delquad::cad
