// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header has the rims and pieces of one patch's layout. The search for layouts uses it.

namespace delquad {

/// Vertex on the rim of a piece, with its number of quads inside.
struct RimVertex {
  int vertex;
  int quads;
};
/// The piece lies on the left of its rim. A cut that opens the piece has both sides on the rim.
using Rim = std::vector<RimVertex>;

/// Vertices of all rims in the parameter plane, with delta' at each.
struct LayoutVertices {
  std::vector<Vec2> places;
  std::vector<double> delta;
};

/// A patch that lines cut into pieces.
struct PatchLayout {
  LayoutVertices vertices;  ///< vertices of the boundary first
  std::vector<Rim> pieces;
};

}  // namespace delquad
