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
  TopoDS_Edge edge;         ///< edge with its orientation in the wire
  std::vector<int> points;  ///< points of the outline, by ascending parameter of the edge
};

/// The boundary of a face as chords in its parameter plane.
struct FaceOutline {
  std::vector<EdgePassage> passages;
  std::vector<Vec2> uv;      ///< parameters of the points
  std::vector<Vec3> points;  ///< places on the face without its placement
};

/// A chord of a passage between its points k and k + 1.
struct OutlineChord {
  int passage, k;
};

/// Returns the outline of a face without placement, with forward orientation (own method). Ends of edges at a
/// vertex that are nearest to each other in the parameter plane become one point. If `collapses`, degenerate
/// edges are left out unless they are at a pole. Throws InputError for an end without partner and edges
/// without a parameter curve.
FaceOutline outline_of(const TopoDS_Face& face, EdgeChords& chords, bool collapses);

/// Returns the chords in the direction of the wires, with the face on their left, and edges inside the face
/// in both directions. `scale` multiplies parameters.
PatchBoundary boundary_of(const FaceOutline& outline, Vec2 scale);

/// Returns the chords that cross, overlap, or touch except at common ends.
std::vector<OutlineChord> crossing_chords(const FaceOutline& outline, Vec2 scale);

/// Bounds for the triangles of a face.
struct FaceBounds {
  double deflection = 0;  ///< largest distance between a triangle and its surface, a length
  double angle = 0;       ///< largest angle between the normals at the ends of an inner side, radians
  int most_points = 0;    ///< limit of points inside
};

struct RefinedFace {
  TriPatch flat;             ///< triangulation in parameters times `scale`
  std::vector<Vec3> points;  ///< places in space, on the surface except for points of the boundary
  bool is_complete = true;   ///< false: `most_points` were not enough
};

/// Returns a Delaunay triangulation in scaled parameters, refined at the middles of inner sides until it
/// keeps the bounds (own method). `points` are the places in space of the boundary's points.
RefinedFace refine_face(const Geom_Surface& surface, const TriPatch& start, std::vector<Vec3> points,
                        Vec2 scale, const FaceBounds& bounds);

/// Returns the factors that turn parameters into approximate lengths: mean speeds of the surface around these
/// parameters.
Vec2 parameter_scale(const Geom_Surface& surface, const std::vector<Vec2>& uv);

/// Faces that were triangulated from their outlines, by number in the map.
struct OutlineMeshes {
  std::vector<int> meshed;  ///< triangulated faces, ascending; also neighbors of wanted ones
  std::vector<int> coarse;  ///< faces among them with too few points for the bounds
  std::vector<std::pair<int, std::string>> failed;  ///< other wanted faces, with the reason
};

/// Triangulates faces (numbers in the map) without the kernel's mesher (own method). Their edges get the
/// chords of their neighbors, and outlines are triangulated in the parameter plane. Points are added on the
/// surface until `deflection` (a length) and `angle` (radians) are kept. Chords that cross are halved, and
/// all faces of their edges are then triangulated again. Earlier triangulations are replaced.
OutlineMeshes mesh_by_outline(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                              const std::vector<int>& wanted, double deflection, double angle);

}  // namespace delquad::cad
