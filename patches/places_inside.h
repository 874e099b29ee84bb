#pragma once

#include <array>
#include <span>
#include <vector>

#include "patches/surface_domain.h"

namespace delquad {

/// The places in space of the points inside a patch, `points` being first those of its boundary, whose nodes
/// are at `nodes` (all of the surface). `sides` are those of the patch's elements, each once at least.
///
/// A node lies on its true curve, off the fine triangulation. Where this is much against the sides at it, as
/// in a face that is hardly wider, the points inside would end up beyond it: they are shifted along, by the
/// mean of the shifts around, the nearest points counting most.
std::vector<Vec3> places_inside(const SurfacePatch& patch, const SurfaceModel& model,
                                std::span<const Vec2> points, const std::vector<std::array<int, 2>>& sides,
                                const std::vector<Vec3>& nodes);

}  // namespace delquad
