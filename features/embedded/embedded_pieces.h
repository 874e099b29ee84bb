// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/curve_span.h"

// This header places points and curves inside of planar regions. Curves and given meshes use it.

namespace delquad {

/// Returns whether one of these curves of the model is a crack.
bool is_crack(const PlanarModel& model, const std::vector<int>& curves);

/// Returns the ends of the two edges that make a lone point of a region a node, one pair for each of
/// `points`. Edges are about as long as `sizes`, shorter near curves or other points, and point away from the
/// nearest one. Throws InputError, with the label of the point, if an edge has no room for a thousandth of
/// its size. Own method.
std::vector<std::array<Vec2, 2>> dangling_ends(const std::vector<CurveSpan>& curves,
                                               const std::vector<Vec2>& points,
                                               const std::vector<double>& sizes,
                                               const std::vector<std::string>& labels);

/// Gives points that are on no curve two edges, pieces without curves. Throws InputError as dangling_ends().
/// `fold(at, x)`: mirrors x as it mirrors `at` into the fundamental part of a symmetric model.
void add_dangling_edges(const PlanarModel& model, const SizeField& size,
                        const std::function<Vec2(Vec2, Vec2)>& fold, ModelChain& chain,
                        std::vector<CurvePiece>& pieces);

/// Throws InputError unless points with such edges lie in a region, and curves without a loop on no boundary.
/// `lines` has the lines of the pieces. Curves of the model from `first_axis` on may lie anywhere.
void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    int first_axis, const Mesh& lines, const Arrangement& arrangement,
                    const FaceRegions& regions);

}  // namespace delquad
