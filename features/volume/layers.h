// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header grows layers of hexahedra from the skin of a body. Volume meshes use it.

namespace delquad {

/// Tells where layers are lower or end.
struct GrownLayers {
  double least = 1;  ///< least part of the height that has room where layers stand
  Vec3 least_at;
  int n_bare = 0;  ///< quads without layers, of those that should have them
  Vec3 bare_at;    ///< of one of them
};

/// Fills a body, whose quads are its closed skin and look outwards, with layers on the quads with
/// `has_layers` and other cells. `heights`: of the layers' ends above the quads, ascending. `place` puts
/// cells into the smaller body inside, and fill_around() fills what is left; `improve` is for it. Returns the
/// quads at which that fails; empty: the body is full.
///
/// * Layers grow in the direction that all quads of layers at a point see best. They have their heights above
///   planes that meet in up to three directions.
/// * At quads without layers they end on rows of quads, as layers of the plane leave them. These have similar
///   proportions, and at most twice the height.
/// * Elsewhere heights fall to zero there, by prisms, and at corners by pyramids and tetrahedra.
/// * Heights shrink, with a bounded slope, where fronts meet or cells are not proven positive. Layers end
///   where nothing is left.
///
/// Own method.
std::vector<int> fill_with_layers(Mesh& body, const std::vector<char>& has_layers,
                                  std::span<const double> heights, const std::function<void(Mesh&)>& place,
                                  bool improve, GrownLayers& grown);

}  // namespace delquad
