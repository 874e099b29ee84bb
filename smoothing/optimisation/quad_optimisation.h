#pragma once

#include "fields/cross_field.h"
#include "fields/size_field.h"
#include "mesh/patch.h"
#include "smoothing/optimisation/optimisation_options.h"

namespace delquad {

/// Opens edges without length and untangles what is inverted or flat, with its surroundings. Connectivity and
/// boundary points stay. Returns how many quads are no more so. Throws std::invalid_argument where the input
/// is not conforming.
int untangle_flat(QuadPatch& mesh, const ParametricSize& size);

/// untangle_flat(), then optimise_on_tracks() in the patch's plane with the boundary points as they are.
/// Vertices of leftover triangles stay.
QuadPatch optimise_vertices(QuadPatch mesh, const ParametricSize& size, const CrossField& cross,
                            const OptimisationOptions& options = {}, OptimisationSummary* summary = nullptr);

}  // namespace delquad
