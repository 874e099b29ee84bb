// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"
#include "features/volume/body_parts.h"
#include "features/volume/skin.h"

// This header recognizes hexahedra between the points of a lattice. Volume meshing uses it.

namespace delquad {

using Hexahedron = std::array<int, 8>;

/// Returns hexahedra between points whose twelve edges join points that lie `beside` each other. Each is
/// there once. They meet the skin only in its vertices, edges and quads.
std::vector<Hexahedron> find_hexahedra(const std::vector<Vec3>& points,
                                       const std::vector<std::vector<int>>& beside, const Skin& skin);

/// Returns hexahedra of which two share nothing, a vertex, an edge or a side, and do not overlap. They are
/// chosen greedily from the skin inwards, then exchanged while their number grows.
std::vector<Hexahedron> select_hexahedra(const std::vector<Vec3>& points, const std::vector<Quad>& quads,
                                         const std::vector<Hexahedron>& candidates);

/// Returns whether each point is a vertex of hexahedra that leave no room around it.
std::vector<char> enclosed_points(const Mesh& body);

/// Removes hexahedra until the sides that bound the rest of the body do not cross, with either diagonal
/// (exact).
void separate_sides(Mesh& body);

}  // namespace delquad
