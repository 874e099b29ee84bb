#pragma once

#include "algorithms/insertion/frontal_mesher.h"

namespace delquad {

/// P: packs vertices along the cross, then fills what is left by the frontal mesher with `filler`.
///
/// First in, first out from the boundary's points, each vertex proposes its four neighbours in a grid: one
/// step of length delta' along each direction of the cross, by the midpoint rule. A proposal is refused
/// outside the domain and by the same tests as in mesh_frontal(). A vertex knows of no front and no
/// triangles, so that legs and diagonals of half squares cannot be taken for each other.
///
/// After the packing of parallelograms in Gmsh (algorithm 9).
TriPatch mesh_packing(const PatchBoundary& boundary, const PointPlacement& filler, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

}  // namespace delquad
