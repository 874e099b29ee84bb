#pragma once

#include <vector>

#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/grid_sides.h"

namespace delquad {

/// A face of a planar domain that is to become a grid.
struct MappedPlanarFace : MappedFace {
  std::vector<Vec2> nodes = {};  ///< at which the parts of its outline begin, loop by loop
};

/// The faces to map, see GridFinder. Throws InputError as it does.
std::vector<MappedPlanarFace> find_mapped_faces(const PlanarModel& model, const MappedSpec& spec,
                                                const Mesh& lines, const Arrangement& arrangement,
                                                const FaceRegions& regions, const ModelChain& chain,
                                                const std::vector<CurvePiece>& pieces);

/// Numbers of edges so that mapped faces have what they need, and every other region an even one around it.
/// `grid_size`: see CurveMeshOptions. Faces that are not asked for may drop out. Throws InputError where what
/// was divided forbids that.
void balance_mapped(const PlanarModel& model, std::vector<MappedPlanarFace>& mapped,
                    const Arrangement& arrangement, const FaceRegions& regions, const PointSize& grid_size,
                    std::vector<CurvePiece>& pieces);

/// The patches that these faces are, with the points of their boundaries at which sides begin (a ring: none).
/// `points`: those of the domain's boundary.
std::vector<MappedPatch> mapped_patches(const std::vector<MappedPlanarFace>& mapped,
                                        const std::vector<CurvePiece>& pieces,
                                        const std::vector<PatchBoundary>& patches,
                                        const std::vector<Vec3>& points);

}  // namespace delquad
