// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "io/cell_view.h"

// This header joins the sides of a mesh's boundary. Formats of coasts and of flow solvers use it.

namespace delquad {

/// Returns the edges joined where one begins at the end of another: the nodes of each chain one after the
/// other. A closed chain has the first node again at the end. Chains end where not just one edge goes on.
std::vector<std::vector<int>> join_edges(const std::vector<std::array<int, 2>>& edges);

/// Returns the groups of lines, as indices, by their ends, the lower one first.
std::map<std::array<int, 2>, int> groups_of_lines(const Mesh& mesh, const std::vector<MeshGroup>& groups);

/// A side on the boundary of the mesh, which lies on its left.
struct BoundarySide {
  std::array<int, 2> run;
  int element, side;  ///< as in CellSide
  int group;          ///< index into the groups of the mesh; -1: no line is there
};
/// Returns all sides of the boundary, sorted by their first node.
std::vector<BoundarySide> boundary_sides(const Mesh& mesh, const std::vector<MeshGroup>& groups);

/// A piece of the boundary for codes that know open ones, where water comes and goes, and land.
struct CoastPiece {
  std::vector<int> nodes;  ///< the mesh lies on their left; of an island the first is not there again
  std::string name;
  bool open, island;
};
/// Pieces with one name each, first the open ones, those whose name contains "open", small or large. A hole
/// without an open side is one piece, an island. An outer boundary with a single name becomes two pieces, as
/// SCHISM needs it.
std::vector<CoastPiece> coast_pieces(const Mesh& mesh);

}  // namespace delquad
