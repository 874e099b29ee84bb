#pragma once

#include <vector>

#include "geometry/planar/grid_sides.h"
#include "patches/surface_curves.h"

namespace delquad {

/// The patches (MappedFace::face) that become grids of their faces, see GridFinder. A face that was cut open
/// into one patch may be a tube, with the cut on two opposite sides. Throws InputError as GridFinder does,
/// and for a named face of several patches.
std::vector<MappedFace> find_surface_grids(const MappedSpec& spec, const Mesh& fine,
                                           const SurfaceCurves& curves, const CurveDemands& wanted);

/// Numbers of edges of chains so that mapped patches have what they need, and the others an even number
/// around; those for which that cannot be are `odd_patches`. Patches that are not asked for may drop out of
/// `mapped`. Throws InputError where a named face cannot be a grid.
std::vector<int> grid_counts(const MappedSpec& spec, const Mesh& fine, const SurfaceCurves& curves,
                             const CurveDemands& wanted, std::vector<MappedFace>& mapped,
                             std::vector<int>& odd_patches);

/// The same by the places where sides begin on the patches' boundaries.
std::vector<MappedPatch> grid_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                      const std::vector<int>& counts);

}  // namespace delquad
