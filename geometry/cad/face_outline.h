#pragma once

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/cad/edge_chords.h"

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

/// The outline of a face that is not placed and looks forward. Ends of edges that meet are one point: those
/// of a vertex that are nearest to each other in the parameter plane. `collapses`: without degenerate edges
/// that are not at a pole, but lead through the tolerance of a vertex. Throws InputError where an end finds
/// none.
FaceOutline outline_of(const TopoDS_Face& face, EdgeChords& chords, bool collapses);

/// The chords from point to point in the direction of the wires, the face on their left; edges inside the
/// face in both directions. `scale` multiplies parameters.
PatchBoundary boundary_of(const FaceOutline& outline, Vec2 scale);

/// Chords that cross, overlap, or touch elsewhere than at their ends.
std::vector<OutlineChord> crossing_chords(const FaceOutline& outline, Vec2 scale);

}  // namespace delquad::cad
