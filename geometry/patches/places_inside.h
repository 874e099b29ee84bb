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

/// Returns the places in space of the points inside a patch. `points` begins with points of its boundary,
/// whose nodes are at `nodes` (all of the surface). `sides` are sides of the patch's elements, each once at
/// least.
///
/// A node lies on its true curve, off the fine triangulation. Where this is much against the sides at it, as
/// in a face that is hardly wider, the points inside would end up beyond it. They are shifted along, by the
/// mean of the shifts around, the nearest points counting most.
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
