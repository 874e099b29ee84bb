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
  std::vector<double> parameters;  ///< of the points of its chain of lines
};

/// A point put inside a face, on the middle of a side.
struct PointInside {
  int point, face;  ///< indices, of points and regions
};

struct WeldedFaces {
  Mesh mesh;  ///< regions are the faces, without names
  std::vector<CurveMesh> curves;
  std::vector<int> corners;
  std::vector<EmbeddedCurve> embedded;  ///< edges inside of faces, by curve
  std::vector<PointInside> inside;      ///< not on the surface yet: see split_duplicate_sides()
  std::vector<int> bad_faces;           ///< triangles miss the boundary by more than `gap`, or are no surface
};

/// Makes one node of the nodes of all faces that stand for the same point of an edge, a vertex or a
/// degenerate edge. Nodes of an edge correspond by their order along it (both sides of a seam too). Edges
/// that are degenerate, or seams of one face, are no curves. Faces without triangles have none afterwards,
/// and edges of no others are no curves. `gap`: a length, see repair_face().
WeldedFaces weld_faces(const std::vector<FaceMesh>& faces, const TopTools_IndexedMapOfShape& edges,
                       double gap);

/// Welds the faces; without those whose triangles turn out to be no use, which get the reason and lose their
/// triangles.
WeldedFaces weld_usable(std::vector<FaceMesh>& meshes, const TopTools_IndexedMapOfShape& edges, double gap,
                        std::vector<std::string>& why_not);

/// Makes the triangles of one face end where its boundary does. `boundary` holds the sides of the face's
/// edges, each in the direction in which its triangle runs along it. The two sides of a seam cancel. Where
/// edges meet at a cusp or a pole the kernel leaves gaps, and pairs of triangles folded onto each
/// other: gaps are filled with the triangles of least area, pairs removed. Returns the greatest ratio of a
/// gap's area to its perimeter, a length: how far off the boundary was.
double repair_face(const std::vector<Vec3>& points, const std::vector<std::array<int, 2>>& boundary,
                   std::vector<std::array<int, 3>>& triangles);

/// Gives sides that two faces both have a node each. Two faces that share more than one curve, or nodes at
/// its ends only, may both have a side between the same two nodes. One or both of these sides are inside, and
/// each is its own way over the surface. Such inner sides get a node on their middle, so that an edge of the
/// mesh tells the sides of its two triangles. `boundary`: the sides (lower node first) that edges of each
/// face have, sorted. Returns the new points.
std::vector<PointInside> split_duplicate_sides(Mesh& mesh,
                                               const std::vector<std::vector<std::array<int, 2>>>& boundary);

/// Returns whether no side belongs to more than two of the triangles.
bool is_manifold(const std::vector<std::array<int, 3>>& triangles);

}  // namespace delquad::cad
