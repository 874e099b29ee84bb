// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/counters.h"
#include "delquad/extend.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/patches/surface_domain.h"

// This header finds the places in space of points inside patches. Repairs, grids and the pipeline use it.

namespace delquad {

/// Returns the places in space of the points inside a patch. `points` begins with points of its boundary;
/// `nodes` has the places of all nodes of the surface. `sides` has each side of the patch's elements, once or
/// twice.
///
/// A node lies on its true curve, off the fine triangulation. If this distance is large against its sides, as
/// in a very narrow face, points inside might lie beyond it. So they are shifted, too, by a mean of the
/// shifts around, where near points count most (own method).
std::vector<Vec3> places_inside(const SurfacePatch& patch, const SurfaceModel& model,
                                std::span<const Vec2> points, const std::vector<std::array<int, 2>>& sides,
                                const std::vector<Vec3>& nodes);

inline const std::vector<Vec2>& points_of(const PatchMesh& patch) {
  return patch.form == PatchForm::kTriangles ? patch.triangles.points : patch.quads.points;
}

/// Returns the places in space of the points inside a patch (by its index); `nodes` belong to the boundaries.
std::vector<Vec3> places_inside(const MeshingSetup& prepared, std::size_t patch, const PatchMesh& mesh,
                                const std::vector<Vec3>& nodes);

/// Adds what a step counted to the log.
template <class Summary>
void add_summary(StageLog& log, const Summary& summary) {
  log.summaries.add(Counters<Summary>::step, fields_of(summary));
}

}  // namespace delquad
