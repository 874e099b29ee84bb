// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header joins points that coincide. Readers of meshes and surfaces use it.

namespace delquad {

/// For each point, the point that replaces it, or itself: names[names[i]] is names[i].
using PointNames = std::vector<int>;

/// Returns for each point the first point with the same coordinates.
PointNames names_of_equal_points(const Mesh& mesh);
/// Returns replacements for ends of open edges (of a single triangle or quad): the nearest point within
/// `tolerance` (a length). This is an earlier end that stays, or a point inside that no side joins to them.
/// All other points stay.
PointNames names_at_open_edges(const Mesh& mesh, double tolerance);

/// Replaces points in elements, named points and periodic nodes. Elements may then repeat a vertex or
/// coincide, and points may be unused. The mesh must have order 1.
void rename_points(Mesh& mesh, const PointNames& names);

/// Joins the ends of open edges to points within `tolerance` (a length), so that a web joins a plate. Keeps
/// one of two lines that meet. Returns "welded 2 points at open edges ..." with the first place; empty: none.
std::string weld_open_edges(Mesh& mesh, double tolerance);

/// Returns a text with the number of ends of open edges within 1e-6 of the diagonal from others, as at
/// cracks, and the first place. Empty: none.
std::string describe_unjoined(const Mesh& mesh);

}  // namespace delquad
