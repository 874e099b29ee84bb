#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/planar/curve_pieces.h"

namespace delquad {

/// A face that is to become a grid: four sides between corners, counterclockwise.
struct MappedFace {
  int face;                               ///< of the arrangement
  bool is_asked;                          ///< by name, and not found
  std::array<std::vector<int>, 4> sides;  ///< pieces
  std::array<int, 4> corners;             ///< nodes, at which the sides begin
};

/// The faces to map: those of the regions that are named, and with kAuto all whose corners are nearly right
/// angles and whose sides want nearly equal numbers of edges. Corners are the four nodes between pieces where
/// the boundary turns most as a rectangle's does. Throws InputError for a name that no region has, and for
/// faces with holes or fewer than four corners.
std::vector<MappedFace> find_mapped_faces(const MappedSpec& spec, const Mesh& lines,
                                          const Arrangement& arrangement, const FaceRegions& regions,
                                          const std::vector<CurvePiece>& pieces);

/// Numbers of edges so that opposite sides of mapped faces have equal ones, and every other region an even
/// one around it. Throws InputError where what was divided forbids that.
void balance_mapped(const PlanarModel& model, std::span<const MappedFace> mapped,
                    const Arrangement& arrangement, const FaceRegions& regions,
                    std::vector<CurvePiece>& pieces);

}  // namespace delquad
