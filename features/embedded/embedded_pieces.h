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

/// A point that stands alone in a region becomes a node because an edge leaves it. Returns the ends of these
/// edges, one for each of `points`. They are about as long as `sizes`, shorter where curves or other points
/// are near, and away from what is next. Throws InputError, naming the point, where there is no room for a
/// thousandth of its size.
std::vector<std::array<Vec2, 2>> dangling_ends(const std::vector<CurveSpan>& curves,
                                               const std::vector<Vec2>& points,
                                               const std::vector<double>& sizes,
                                               const std::vector<std::string>& labels);

/// Gives points that are on no curve two edges, pieces without curves. Throws InputError as dangling_ends().
/// `fold(at, x)`: mirrors x as it mirrors `at` into the fundamental part of a symmetric model.
void add_dangling_edges(const PlanarModel& model, const SizeField& size,
                        const std::function<Vec2(Vec2, Vec2)>& fold, ModelChain& chain,
                        std::vector<CurvePiece>& pieces);

/// Points with such edges lie in a region, and curves that no loop has on no boundary; throws InputError
/// where they do not. `lines`: of the pieces; curves of the model from `first_axis` on may lie anywhere.
void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    int first_axis, const Mesh& lines, const Arrangement& arrangement,
                    const FaceRegions& regions);

}  // namespace delquad
