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

/// How messages call what they are about.
struct BoundaryNames {
  std::string source;                     ///< file; may be empty
  std::function<std::string(int)> curve;  ///< name of a curve, by index into Mesh::curves
  std::string crossing_hint;              ///< added where lines meet; may be empty
  int dangling = -1;                      ///< a curve whose lines may be anywhere

  /// Returns the beginning of messages.
  std::string prefix() const { return source.empty() ? "" : source + ": "; }
};

/// Curves by their groups, or by their tags.
BoundaryNames names_of_curves(const Mesh& lines, const std::string& source);

/// Returns the faces that the lines of a mesh enclose. Throws InputError, naming curves and coordinates, for
/// lines that cross, touch, overlap or occur twice, and for lines without length. The same holds for
/// coincident nodes, coordinates that are not finite, and different z. It also throws if a line has no
/// bounded face on either side: there the boundary is open.
Arrangement arrange_lines(const Mesh& lines, const BoundaryNames& names);

/// Returns the edges of a patch's boundary, loop by loop, each from its first point on.
std::vector<std::vector<int>> loops_of_edges(const PatchBoundary& boundary);

/// Returns one line for each patch whose boundary has an odd number of edges: it names the region, its odd
/// loops and their curves. Such a boundary leaves a triangle when triangles are merged to quads.
std::vector<std::string> odd_boundaries(const PlanarDomain& domain);

/// Returns all edges of the patches' boundaries as lines of one curve, with the points of the domain.
Mesh edges_of_patches(const PlanarDomain& domain);

}  // namespace delquad
