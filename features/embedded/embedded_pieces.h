// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/planar/curve_pieces.h"

// This header places points and curves inside of planar regions. Curves and given meshes use it.

namespace delquad {

/// Returns whether one of these curves of the model is a crack.
bool is_crack(const PlanarModel& model, const std::vector<int>& curves);

/// Gives points that are on no curve two edges, pieces without curves. Throws InputError as dangling_ends().
/// `lines` has the lines of the pieces.
void add_dangling_edges(const PlanarModel& model, const SizeField& size, const Mesh& lines, ModelChain& chain,
                        std::vector<CurvePiece>& pieces);

/// Throws InputError unless points with such edges lie in a region, and curves without a loop on no boundary.
/// `lines` has the lines of the pieces.
void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    const Mesh& lines, const Arrangement& arrangement, const FaceRegions& regions);

}  // namespace delquad
