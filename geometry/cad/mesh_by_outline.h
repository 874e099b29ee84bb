// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Geom_Surface.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/cad/cad_shape.h"
#include "geometry/cad/edge_chords.h"

// This header triangulates CAD faces from their outlines. Geometry uses it.

namespace delquad::cad {

/// One passage of a wire along an edge.
struct EdgePassage {
  TopoDS_Edge edge;         ///< as the wire has it
  std::vector<int> points;  ///< of the outline, in ascending order of the edge's parameter
};

/// The boundary of a face as chords in its parameter plane.
struct FaceOutline {
  std::vector<EdgePassage> passages;
  std::vector<Vec2> uv;
  std::vector<Vec3> points;  ///< of the face as it is when it is not placed
};

/// A chord: which passage, and between which of its points (k, k + 1).
struct OutlineChord {
  int passage, k;
};

/// Returns the outline of a face that is not placed and looks forward. Ends of edges that meet are one point:
/// ends at a vertex that are nearest to each other in the parameter plane. `collapses`: without degenerate
/// edges that are not at a pole, but lead through the tolerance of a vertex. Throws InputError where an end
/// finds none.
FaceOutline outline_of(const TopoDS_Face& face, EdgeChords& chords, bool collapses);

/// Returns the chords from point to point in the direction of the wires, the face on their left; edges inside
/// the face in both directions. `scale` multiplies parameters.
PatchBoundary boundary_of(const FaceOutline& outline, Vec2 scale);

/// Chords that cross, overlap, or touch elsewhere than at their ends.
std::vector<OutlineChord> crossing_chords(const FaceOutline& outline, Vec2 scale);

/// Bounds for the triangles of a face.
struct FaceBounds {
  double deflection = 0;  ///< largest distance between a triangle and its surface, a length
  double angle = 0;       ///< between the normals at the ends of a side inside, radians
  int most_points = 0;    ///< no more are put inside
};

struct RefinedFace {
  TriPatch flat;             ///< in parameters times `scale`
  std::vector<Vec3> points;  ///< on the surface, but for points of the boundary
  bool is_complete = true;   ///< false: `most_points` were not enough
};

/// Puts points on the middles of sides inside a face, Delaunay in scaled parameters, until its triangles keep
/// to the bounds. `points`: of the triangulation's boundary, in space.
RefinedFace refine_face(const Geom_Surface& surface, const TriPatch& start, std::vector<Vec3> points,
                        Vec2 scale, const FaceBounds& bounds);

/// Factors by which parameters become about lengths: the mean speeds of the surface around these parameters.
Vec2 parameter_scale(const Geom_Surface& surface, const std::vector<Vec2>& uv);

/// Faces that were triangulated from their outlines, as numbers in the map.
struct OutlineMeshes {
  std::vector<int> meshed;                          ///< ascending; more than were asked for: see below
  std::vector<int> coarse;                          ///< of these, those with too few points for the bounds
  std::vector<std::pair<int, std::string>> failed;  ///< with the reason
};

/// Triangulates faces (numbers in the map) without the kernel's mesher. Their edges are cut into the chords
/// that their neighbors have, and the outline is triangulated in the parameter plane. Points are put on the
/// surface until `deflection` (a length) and `angle` (radians) are kept. Chords that cross are halved; then
/// all faces of their edges are triangulated so. Earlier triangulations are replaced.
OutlineMeshes mesh_by_outline(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                              const std::vector<int>& wanted, double deflection, double angle);

}  // namespace delquad::cad
