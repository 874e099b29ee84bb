// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header divides polygons into triangles. Readers of meshes and surfaces use it.

namespace delquad {

/// Returns triangles of a polygon in space, oriented like it, as indices of corners. It cuts the best ears
/// first (own order), in quadratic time. Seen along the axis nearest to its normal, the polygon must not
/// cross itself, but corners may coincide, as at a bridge to a hole. Returns nothing for other polygons and
/// without area.
std::optional<std::vector<std::array<int, 3>>> split_polygon(const std::vector<Vec3>& corners);

/// Splits every quad into two triangles by split_polygon(). A quad that crosses itself or has no area is
/// split along its shorter diagonal. `notes` get the number of quads.
void split_quads(Mesh& mesh, ReadNotes& notes);

}  // namespace delquad
