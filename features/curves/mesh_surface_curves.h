// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/matching/matching.h"
#include "features/curves/agreement.h"
#include "features/periodic/periodic.h"
#include "geometry/patches/surface_domain.h"

// This header divides the curves of surfaces into edges. The preparation uses it.

namespace delquad {

/// Meshes the curves of a flattened model once each and gives every patch its boundary. All patches are even
/// wherever that is possible at all. Where a boundary polygon would cross itself in the parameter plane, the
/// curves of that patch are refined. Warnings name the curves shorter than the size and the patches left odd.
/// `asked` is the size that these refer to (null: `size` itself, which may be less beside such curves).
/// Curves of `divisions` get these edges, and the second sides of `periodic` the images of the nodes of the
/// first: faces that are images have no patches, see `boundary.periodic_faces`. Patches that become grids, as
/// `mapped` asks, get numbers that fit. `is_layered`: the curves that get layers, at which no corner is cut
/// off; empty: none. Throws FaceError when no refinement gives a valid boundary, naming
/// the face, and InputError where divisions leave a patch with an odd number of edges.
SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                                  const MatchingSolver& solver, const SizeField* asked = nullptr,
                                  const std::vector<CurveDivision>& divisions = {},
                                  const PeriodicSides& periodic = {}, const MappedSpec& mapped = {},
                                  const CurveAgreement& agreement = {},
                                  const std::vector<char>& is_layered = {});

}  // namespace delquad
