// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "geometry/planar/curve_pieces.h"

// This header places points and curves inside of planar regions. Curves and given meshes use it.

namespace delquad {

/// Returns whether one of these curves of the model is a crack.
bool is_crack(const PlanarModel& model, const std::vector<int>& curves);

/// Gives points that are on no curve two edges, pieces without curves. Throws InputError as dangling_ends().
/// `lines` has the lines of the pieces. `fold(at, x)` mirrors x as it mirrors `at` into the fundamental part
/// of a symmetric model.
void add_dangling_edges(const PlanarModel& model, const SizeField& size, const Mesh& lines,
                        const std::function<Vec2(Vec2, Vec2)>& fold, ModelChain& chain,
                        std::vector<CurvePiece>& pieces);

/// Throws InputError unless points with such edges lie in a region, and curves without a loop on no boundary.
/// `lines` has the lines of the pieces. Curves of the model from `first_axis` on may lie anywhere.
void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    int first_axis, const Mesh& lines, const Arrangement& arrangement,
                    const FaceRegions& regions);

}  // namespace delquad
