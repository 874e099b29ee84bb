// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header joins points that coincide. Readers of meshes and surfaces use it.

namespace delquad {

/// Points of `mesh` by the names they should go by: name[name[i]] is name[i].
using PointNames = std::vector<int>;

/// Returns names by which each point goes by the first with the same coordinates.
PointNames names_of_equal_points(const Mesh& mesh);
/// Ends of open edges, which one triangle or quad only uses, go by the nearest point within `tolerance` (a
/// length). It is an earlier end that keeps its own name, or a point inside that no side joins to them. All
/// other points keep their names.
PointNames names_at_open_edges(const Mesh& mesh, double tolerance);

/// Elements, named points and periodic nodes name their points anew. Elements may end with a repeated vertex
/// or on each other, and points unused. The mesh has order 1.
void rename_points(Mesh& mesh, const PointNames& names);

/// Joins the ends of open edges that are within `tolerance` (a length) of other points, so that a web joins a
/// plate. Keeps one of two lines that meet. Returns "welded 2 points at open edges ..." with the first place;
/// empty: there were none.
std::string weld_open_edges(Mesh& mesh, double tolerance);

/// Says how many ends of open edges coincide with others within 1e-6 of the diagonal, and where the first one
/// is: at cracks, and where a mesh is torn. Empty: there are none.
std::string describe_unjoined(const Mesh& mesh);

}  // namespace delquad
