// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header divides polygons into triangles. Readers of meshes and surfaces use it.

namespace delquad {

/// Cuts a polygon in space into triangles that turn as it does. It cuts the best ears first; the worse of the
/// last two triangles is as good as can be. Seen along the axis nearest to its normal, the polygon must not
/// cross itself. Corners may lie on others, as where a bridge leads to a hole. Returns nothing for other
/// polygons and without area. Indices count the corners.
/// Takes time with the square of their number.
std::optional<std::vector<std::array<int, 3>>> split_polygon(const std::vector<Vec3>& corners);

/// Splits every quad into two triangles for surfaces that are to be meshed: as split_polygon(). A quad that
/// crosses itself or has no area is split along its shorter diagonal. Says so in `notes`.
void split_quads(Mesh& mesh, ReadNotes& notes);

}  // namespace delquad
