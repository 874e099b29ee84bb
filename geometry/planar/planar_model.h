// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "delquad/model.h"

// This header has planar domains, and their curves with nodes. Most modules use it.

namespace delquad {

/// Where a node is on its curve, and how far it may slide: over from <= t <= to.
struct CurvePlace {
  std::shared_ptr<const Curve> curve;  ///< null: the node stays
  double t = 0, from = 0, to = 1;
  bool is_free = false;  ///< it is on no curve and moves freely
};

/// A part of a curve between two nodes at which others meet it, or it ends.
struct DomainPiece {
  std::array<int, 2> ends;  ///< nodes
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;
  std::vector<int> nodes = {};        ///< nodes between the ends
  std::vector<double> interior = {};  ///< parameters of these nodes
  bool is_divided = false;            ///< their number was requested
};

/// A patch that shall become a grid.
struct MappedPatch {
  int patch;
  /// The boundary points at which its sides begin, four or three, in order; none: a ring.
  std::vector<int> corners;
  bool is_requested = true;  ///< requested by name; false: found automatically
  int rows = 0;              ///< rows of a ring; 0: by the size
};

class PatchPlaces;

/// The regions that a line mesh bounds, or the patches of a surface in their parameter planes.
struct PlanarDomain {
  Mesh boundary;  ///< points, lines, curves, regions; the only elements are quads of layers and wedges
  std::vector<CurvePlace> places;  ///< places of the boundary's points; empty if the lines were given
  std::vector<PatchBoundary> patches;
  std::vector<int> patch_region;  ///< region of each patch, index into boundary.regions
  std::vector<MappedPatch> mapped;
  bool has_junctions = false;  ///< some node has other than two lines
  std::vector<int> on_crack;   ///< nodes along cracks, doubled and others
  /// For each curve, the model's curves on it. Empty if the lines were given, and for second lips of cracks.
  std::vector<std::vector<int>> model_curves;
  /// The shapes of these curves; for a second lip the shapes of all cracks.
  std::vector<std::vector<std::shared_ptr<const Curve>>> curve_shapes = {};
  std::vector<DomainPiece> pieces = {};  ///< pieces of the curves; empty if the lines were given
  /// With layers or wedges: the patches that include them. `patches` are the rest, which stages mesh.
  std::vector<PatchBoundary> outlines = {};
  std::vector<std::string> notes = {};    ///< for warnings
  const PatchPlaces* in_space = nullptr;  ///< of a surface's patches; null: they lie in the domain's plane
};

/// Returns the domain that lines of any order and orientation enclose: regions side by side, and by nesting
/// outer regions, holes and islands (see regions_by_nesting()). Lines with a region on both sides are
/// interfaces; lines that end inside of a region are embedded in it. Regions are in the order of their
/// lexicographically smallest nodes. In `boundary` points with lines and lines keep their order; a line has
/// its region, or the inner one of two, on its left. A patch's points follow its outline, then round the
/// loops inside, each from its lexicographically smallest node. Throws as arrange_lines() and build_domain();
/// messages begin with `source`.
PlanarDomain make_domain(Mesh lines, const std::string& source = {});

}  // namespace delquad
