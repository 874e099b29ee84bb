// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/matching/matching.h"
#include "features/curves/agreement.h"
#include "features/periodic/periodic.h"
#include "geometry/patches/surface_domain.h"

// This header divides the curves of surfaces into edges. The preparation uses it.

namespace delquad {

/// Divides the curves of a flattened model, each once, and returns the domain with the boundary of each
/// patch. All patches are even if that is possible. If a boundary polygon crosses itself in the parameter
/// plane, the curves of that patch are refined. Warnings name curves shorter than the size, and odd patches.
///
/// They refer to the size `asked`; null: to `size`, which may be less beside short curves. Curves of
/// `divisions` get these edges. The second sides of `periodic` get the images of the nodes of the first.
/// Faces that are images have no patches, see `boundary.periodic_faces`. Patches that become grids, by
/// `mapped`, get numbers that fit. `is_layered` marks curves with layers, at which no corner is cut off;
/// empty: none.
///
/// Throws FaceError, with the face, if no refinement gives a valid boundary. Throws InputError if divisions
/// leave a patch with an odd number of edges.
SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                                  const MatchingSolver& solver, const SizeField* asked = nullptr,
                                  const std::vector<CurveDivision>& divisions = {},
                                  const PeriodicSides& periodic = {}, const MappedSpec& mapped = {},
                                  const CurveAgreement& agreement = {},
                                  const std::vector<char>& is_layered = {});

}  // namespace delquad
