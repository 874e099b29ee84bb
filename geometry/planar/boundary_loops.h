#pragma once

#include <functional>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// How messages call what they are about.
struct BoundaryNames {
  std::string source;                     ///< file; may be empty
  std::function<std::string(int)> curve;  ///< name of a curve, by index into Mesh::curves
  std::string crossing_hint;              ///< added where lines meet; may be empty
};

/// Curves by their groups, or by their tags.
BoundaryNames names_of_curves(const Mesh& lines, const std::string& source);

/// A closed polygon of lines, counterclockwise, from its lexicographically smallest node on.
struct BoundaryLoop {
  std::vector<int> nodes;
  std::vector<int> lines;  ///< lines[k] joins nodes[k] and nodes[k + 1]
  int parent = -1;         ///< the innermost loop around it, -1 if none
};

/// The loops that the lines form, in the order of their first nodes; a parent comes before what it holds. The
/// same for any order and orientation of the lines. Throws InputError as make_domain() does.
std::vector<BoundaryLoop> find_loops(const Mesh& lines, const BoundaryNames& names);

/// Which loops have a region just inside: those around nothing but void, and those that are `named`.
std::vector<bool> filled_loops(const std::vector<BoundaryLoop>& loops, const std::vector<bool>& named);

/// Index of the loop of each node, -1 for nodes on none.
std::vector<int> loop_of_nodes(const std::vector<BoundaryLoop>& loops, std::size_t node_count);

}  // namespace delquad
