// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "io/cell_view.h"

// This header joins the sides of a mesh's boundary. Formats of coasts and of flow solvers use it.

namespace delquad {

/// Returns chains of edges joined end to beginning: the nodes of each chain in order. A closed chain repeats
/// its first node at the end. Chains end at nodes where not exactly one edge continues.
std::vector<std::vector<int>> join_edges(const std::vector<std::array<int, 2>>& edges);

/// Returns the index of the group of each line, by the ends of the line, the lower one first.
std::map<std::array<int, 2>, int> groups_of_lines(const Mesh& mesh, const std::vector<MeshGroup>& groups);

/// A side on the boundary of the mesh, with the mesh on its left.
struct BoundarySide {
  std::array<int, 2> run;
  int element, side;  ///< as in CellSide
  int group;          ///< index into the groups of the mesh; -1: no line lies there
};
/// Returns all sides of the boundary, sorted by their first node.
std::vector<BoundarySide> boundary_sides(const Mesh& mesh, const std::vector<MeshGroup>& groups);

/// A piece of the boundary for codes that distinguish land from open sides, where water comes and goes.
struct CoastPiece {
  std::vector<int> nodes;  ///< in order, with the mesh on their left; an island does not repeat the first
  std::string name;
  bool open, island;
};
/// Returns pieces with one name each, open ones first. Open is a piece whose name contains "open" in any
/// case. A hole without an open side is one piece, an island. An outer boundary with a single name becomes
/// two pieces, as SCHISM needs it.
std::vector<CoastPiece> coast_pieces(const Mesh& mesh);

}  // namespace delquad
