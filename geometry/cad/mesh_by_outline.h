#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <string>
#include <utility>
#include <vector>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// What has become of faces that were triangulated from their outlines. Numbers in the map.
struct OutlineMeshes {
  std::vector<int> meshed;                          ///< ascending; more than were asked for: see below
  std::vector<int> coarse;                          ///< of these, those with too few points for the bounds
  std::vector<std::pair<int, std::string>> failed;  ///< with the reason
};

/// Triangulates faces (numbers in the map) without the kernel's mesher: their edges are cut into the chords
/// that their neighbours have, the outline is triangulated in the parameter plane, and points are put on the
/// surface until `deflection` (a length) and `angle` (radians) are kept. Chords that cross are halved; then
/// all faces of their edges are triangulated so. What they had before is replaced.
OutlineMeshes mesh_by_outline(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                              const std::vector<int>& wanted, double deflection, double angle);

}  // namespace delquad::cad
