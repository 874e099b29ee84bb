// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/surface/flatten.h"

// This header walks along the outline of a patch's map. Patches and given meshes use it.

namespace delquad {

/// A side of a patch's map on a line of a curve.
struct CurveSide {
  int from, to;     ///< vertices of the map
  int chain, line;  ///< chain, and line as its k-th
  bool forward;     ///< whether its direction is the curve's

  /// Returns whether it is the first side of its curve in a loop.
  bool begins(const CurveChain& c) const {
    return forward ? line == 0 : line + 2 == static_cast<int>(c.points.size());
  }
};

/// The boundary of a map as loops of sides, each beginning where a curve does.
using PatchOutline = std::vector<std::vector<CurveSide>>;

/// Finds the lines of curves by their ends.
class LineIndex {
 public:
  explicit LineIndex(const std::vector<CurveChain>& chains);
  /// Returns the outline of a map. Throws std::logic_error, with the face, if a side of its boundary lies on
  /// no curve.
  PatchOutline outline(const FlatPatch& map, const std::vector<CurveChain>& chains,
                       const std::string& face) const;

 private:
  struct Line {
    int chain, line;
    int first;  ///< fine point at which the line begins
  };
  std::unordered_map<long long, Line> lines_;  // only looked up, never iterated
};

/// Returns the boundary polygon of the nodes in the parameter plane. `edge_chain`, unless null, gets the
/// chain of each edge.
PatchBoundary place_boundary(const FlatPatch& map, const PatchOutline& outline,
                             const std::vector<CurveChain>& chains, const SurfaceNodes& nodes,
                             std::vector<int>* edge_chain = nullptr);

/// Returns whether the boundary can be triangulated: no points coincide, and its loops enclose an area on
/// their left.
bool meshable(const PatchBoundary& boundary);

}  // namespace delquad
