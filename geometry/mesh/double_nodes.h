// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <vector>

#include "base/disjoint_sets.h"
#include "delquad/mesh.h"

// This header opens meshes along cracks. Planar domains and surfaces use it.

namespace delquad {

/// Gives corners of faces that `opens` their own nodes, unless they are `joined`. The first set of corners at
/// a node keeps it; the others get copies behind all points. `node` has the node of each corner.
void double_nodes(DisjointSets& joined, const std::vector<char>& opens, std::vector<int>& node,
                  std::vector<Vec3>& points);

/// Adds a line of the second lip of a crack. `lips` has the curve of the second lip of each crack; a new one
/// gets the names of the crack.
void add_lip_line(Mesh& mesh, int crack, const std::array<int, 2>& line, std::map<int, int>& lips);

}  // namespace delquad
