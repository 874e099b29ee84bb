#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A vertex on the rim of a piece of a patch, and how many quads it gets inside.
struct RimVertex {
  int vertex;
  int quads;
};
/// The piece lies on its left. Where a cut opens the piece, both of its sides are on the rim.
using Rim = std::vector<RimVertex>;

/// All vertices that rims have.
struct LayoutVertices {
  std::vector<Vec2> places;
  std::vector<double> delta;
};

/// A patch cut into pieces along lines: what numbers of edges leave as it is.
struct PatchLayout {
  LayoutVertices vertices;  ///< those of the boundary first
  std::vector<Rim> pieces;
};

}  // namespace delquad
