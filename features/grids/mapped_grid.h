// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/extend.h"

// This header fills patches with grids by transfinite interpolation. The pipeline and features use it.

namespace delquad {

/// A grid before anything is known of its quads: the boundary's points, those inside, and the quads.
template <class Vec>
struct MappedGrid {
  std::vector<Vec> points;
  std::vector<std::array<int, 4>> quads;
};

/// Returns the grid of a patch by transfinite interpolation [Gordon and Hall 1973]. The points of the
/// boundary, counterclockwise, are at `places`, in the plane or in space. The parameters of the grid follow
/// the lengths along opposite sides. `corners`: the points at which its sides begin. If there are four,
/// opposite sides have equal numbers of edges. If there are three, the sides are divided so that three grids
/// fit, which meet in the mean of the places of division [midpoint subdivision]. If there is none, two loops
/// of equally many edges are joined by straight lines with nodes at `layers`. These are parts of the way from
/// the outer loop, without the ends. Returns nothing if the numbers of edges do not fit.
template <class Vec>
std::optional<MappedGrid<Vec>> interpolated_grid(const PatchBoundary& boundary,
                                                 const std::vector<Vec>& places,
                                                 const std::vector<int>& corners,
                                                 const std::vector<double>& layers);

/// Returns where the nodes between the loops of a ring lie, by the mean of the sizes along the lines between
/// them.
std::vector<double> ring_layers(const PatchBoundary& boundary, const ParametricSize& size);

/// Returns whether all corners of all quads turn left, by exact predicates. Else `at` is the first one that
/// does not.
bool are_convex(const std::vector<Vec2>& points, const std::vector<std::array<int, 4>>& quads,
                Vec2* at = nullptr);

/// Moves the points inside until the quads are convex, where that can be. Then moves them all together as
/// stage O does, for shape and lengths; no quad gets inverted.
void smooth_grid(QuadPatch& grid, const CrossField& cross, const ParametricSize& size);

/// Returns a grid in the form that a stage leaves.
PatchMesh grid_as(PatchForm form, const QuadPatch& grid);

}  // namespace delquad
