// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/planar_model.h"

// This header checks lines that bound a planar domain. Planar domains and reports use it.

namespace delquad {

/// Names of lines in messages.
struct BoundaryNames {
  std::string source;                     ///< file; may be empty
  std::function<std::string(int)> curve;  ///< name of a curve, by index into Mesh::curves
  std::string crossing_hint;              ///< added where lines meet; may be empty
  int dangling = -1;                      ///< curve whose lines need not bound a region; -1: none

  /// Returns the beginning of messages.
  std::string prefix() const { return source.empty() ? "" : source + ": "; }
};

/// Returns names of curves by their groups, or by their tags.
BoundaryNames names_of_curves(const Mesh& lines, const std::string& source);

/// Returns the faces that the lines of a mesh enclose. Throws InputError, naming curves and coordinates, for
/// lines that cross, touch, overlap, occur twice or have no length. It also throws for coincident nodes,
/// coordinates that are not finite, different z, and open boundaries, at lines without a bounded face on
/// either side.
Arrangement arrange_lines(const Mesh& lines, const BoundaryNames& names);

/// Returns the edges (indices) of a patch's boundary, loop by loop, each from its first point on.
std::vector<std::vector<int>> loops_of_edges(const PatchBoundary& boundary);

/// Returns a text for each patch whose boundary has an odd number of edges, with region, odd loops and their
/// curves. Such a boundary leaves a triangle beside the quads.
std::vector<std::string> odd_boundaries(const PlanarDomain& domain);

/// Returns all edges of the patches' boundaries as lines of one curve, with the points of the domain.
Mesh edges_of_patches(const PlanarDomain& domain);

}  // namespace delquad
