#pragma once

#include "patches/surface_domain.h"

namespace delquad {

/// The domain of a model whose curves are kept point by point: all their points are nodes, and no stage moves
/// those that are on no cut. The k-th point of a patch's boundary is the vertex of its map from which the
/// k-th side of its outline begins. Warnings name the patches with an odd boundary.
SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size);

}  // namespace delquad
