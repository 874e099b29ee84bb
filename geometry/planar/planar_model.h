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
  bool is_free = false;  ///< it is on no curve: it may go anywhere
};

/// A part of a curve between two nodes at which others meet it, or it ends.
struct DomainPiece {
  std::array<int, 2> ends;  ///< nodes
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;
  std::vector<int> nodes = {};        ///< between the ends
  std::vector<double> interior = {};  ///< their parameters
  bool is_divided = false;            ///< their number was asked for
};

/// A patch that is a mirror image of another.
struct PatchImage {
  int patch, master;
  std::vector<int> point;            ///< of each point of the master's boundary the one here
  std::function<Vec2(Vec2)> motion;  ///< that takes the master there
  bool is_mirrored = true;           ///< else turned: mirrored twice
};

/// A patch that is to become a grid.
struct MappedPatch {
  int patch;
  /// The points of its boundary at which its sides begin, four or three, one after the other; none: a ring.
  std::vector<int> corners;
  bool is_requested = true;  ///< by name, and not found
  int rows = 0;              ///< of a ring; 0: as the size asks for
};

class PatchPlaces;

/// The regions that a line mesh bounds, or the patches of a surface in their parameter planes.
struct PlanarDomain {
  Mesh boundary;  ///< points, lines, curves, regions; of elements the quads of layers and wedges alone
  std::vector<CurvePlace> places;  ///< of the boundary's points; empty where the lines were given
  std::vector<PatchBoundary> patches;
  std::vector<int> patch_region;  ///< index into boundary.regions of each patch
  std::vector<MappedPatch> mapped;
  std::vector<PatchImage> images;
  bool has_junctions = false;  ///< some node has other than two lines
  std::vector<int> on_crack;   ///< nodes along cracks, those that were doubled and the others
  /// For each curve the curves of the model that lie there. It is empty if the lines were given, and for
  /// second lips of cracks.
  std::vector<std::vector<int>> model_curves;
  /// Their shapes; for a second lip the shapes of all cracks.
  std::vector<std::vector<std::shared_ptr<const Curve>>> curve_shapes = {};
  std::vector<DomainPiece> pieces = {};  ///< of the curves; empty where the lines were given
  /// Where there are layers or wedges: the patches with these. `patches` are what is left to be meshed.
  std::vector<PatchBoundary> outlines = {};
  std::vector<std::string> notes = {};    ///< for warnings
  const PatchPlaces* in_space = nullptr;  ///< of a surface; null: the patches lie in the plane of the domain
};

/// Tells what the lines enclose, whatever their order and orientation: regions side by side, and by nesting
/// outer ones, holes and islands (see regions_by_nesting()). Lines with a region on both sides are
/// interfaces, lines that end inside of a region stand in it. Regions are in the order of their
/// lexicographically smallest nodes. In `boundary` the points keep their order, without the points that have
/// no lines. The lines keep theirs, too, turned so that the region lies on their left (the inner one of two).
/// A patch's points go round its outline, then round the loops inside, each from its lexicographically
/// smallest node. Throws InputError as arrange_lines() and build_domain(); messages call the lines by
/// `source`.
PlanarDomain make_domain(Mesh lines, const std::string& source = {});

}  // namespace delquad
