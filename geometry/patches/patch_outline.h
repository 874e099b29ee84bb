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

/// Where a side of a patch's map lies on a curve.
struct CurveSide {
  int from, to;     ///< vertices of the map
  int chain, line;  ///< line: the chain's k-th
  bool forward;     ///< runs with the curve

  /// Returns whether it is the first that a loop meets of its curve.
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
  /// Throws std::logic_error, naming the face, where a side of the map's boundary lies on no curve.
  PatchOutline outline(const FlatPatch& map, const std::vector<CurveChain>& chains,
                       const std::string& face) const;

 private:
  struct Line {
    int chain, line;
    int first;  ///< fine point at which the line begins
  };
  std::unordered_map<long long, Line> lines_;  // only looked up, never iterated
};

/// Returns the boundary polygon in the parameter plane that the nodes make. `edge_chain` (if any) receives
/// the curve chain of each edge.
PatchBoundary place_boundary(const FlatPatch& map, const PatchOutline& outline,
                             const std::vector<CurveChain>& chains, const SurfaceNodes& nodes,
                             std::vector<int>* edge_chain = nullptr);

/// Does the boundary enclose an area? Only the triangulation can tell: it also finds points that coincide and
/// loops that are turned inside out.
bool meshable(const PatchBoundary& boundary);

}  // namespace delquad
