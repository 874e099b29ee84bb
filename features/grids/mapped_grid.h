// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/extend.h"

// This header fills patches with grids by transfinite interpolation. The pipeline and features use it.

namespace delquad {

/// A grid of unknown quality: the points of the boundary, inner points, and the quads.
template <class Vec>
struct MappedGrid {
  std::vector<Vec> points;
  std::vector<std::array<int, 4>> quads;
};

/// Returns the grid of a patch by transfinite interpolation [coons1967]. The points of the boundary,
/// counterclockwise, are at `places`, in the plane or in space. The parameters of the grid follow the lengths
/// along opposite sides. `corners` are the points at which its sides begin.
///
/// With four, opposite sides have equal numbers of edges. With three, the sides are divided so that three
/// grids fit, which meet at the mean of the places of division (midpoint subdivision). With none, straight
/// lines join two loops of equal numbers of edges, with nodes at `layers`. These are shares of the way from
/// the outer loop, without the ends. Returns nothing if the numbers of edges do not fit.
template <class Vec>
std::optional<MappedGrid<Vec>> interpolated_grid(const PatchBoundary& boundary,
                                                 const std::vector<Vec>& places,
                                                 const std::vector<int>& corners,
                                                 const std::vector<double>& layers);

/// Returns the places of nodes between the loops of a ring, as shares of the way, by the mean size along the
/// lines between them.
std::vector<double> ring_layers(const PatchBoundary& boundary, const ParametricSize& size);

/// Returns whether all corners of all quads turn left, by exact predicates. Otherwise `at` gets the first
/// corner that does not; it may be null.
bool are_convex(const std::vector<Vec2>& points, const std::vector<std::array<int, 4>>& quads,
                Vec2* at = nullptr);

/// Moves the inner points until the quads are convex, if possible. Then it moves them together as stage O,
/// for shape and lengths; no quad gets inverted.
void smooth_grid(QuadPatch& grid, const CrossField& cross, const ParametricSize& size);

/// Returns a grid in the form that a stage leaves; triangles are halves of quads.
PatchMesh grid_as(PatchForm form, const QuadPatch& grid);

}  // namespace delquad
