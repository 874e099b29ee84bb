#pragma once

#include <array>
#include <optional>

#include "delquad/extend.h"

namespace delquad {

/// The grid of a patch whose boundary has four sides, which begin at these points of it, by transfinite
/// interpolation [Gordon and Hall 1973], its parameters by the lengths along opposite sides. Nothing where
/// opposite sides have different numbers of edges, or a quad would not be convex.
std::optional<QuadPatch> mapped_grid(const PatchBoundary& boundary, const std::array<int, 4>& corners);

/// A grid in the form that a stage leaves.
PatchMesh grid_as(PatchForm form, const QuadPatch& grid);

}  // namespace delquad
