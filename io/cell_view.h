// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/half_edges.h"
#include "io/entity_names.h"

// This header has views of meshes for writers: blocks of elements, sides and named groups. Readers and
// writers use it.

namespace delquad {

class TextWriter;

/// All elements of one shape. They live as long as their mesh.
struct CellBlock {
  CellShape shape;
  int dim;
  std::size_t n_nodes;  ///< of each element
  std::size_t first;    ///< number of elements of this dimension in earlier blocks; triangles come first
  const std::vector<int>* entity_of;
  const std::vector<Entity>* entities;  ///< curves, regions or volumes
  std::function<std::vector<int>(std::size_t)> nodes;

  std::size_t size() const { return entity_of->size(); }
  const Entity& entity(std::size_t i) const { return (*entities)[(*entity_of)[i]]; }
};

/// Returns blocks of all shapes in their order, without empty ones. `places` orders the nodes of
/// quads, see nodes_of_quad(). By default it is the order of Gmsh, without the middle node if that is a
/// corner, as in write_serendipity().
std::vector<CellBlock> cell_blocks(const Mesh& mesh, std::vector<int> places = {});
/// Returns 3 with cells of volumes, else 2.
int dimension_of(const Mesh& mesh);
/// Returns the number of points (0), of lines (1), of triangles and quads (2), or of cells (3).
std::size_t n_cells(const Mesh& mesh, int dim);
/// Returns whether the nodes in the middle of quads of order 2 are left out.
bool has_eight_nodes(const Mesh& mesh);
/// Returns the places of the corners and of the nodes on sides of quads of order 1 or 2, for formats without
/// inner nodes.
std::vector<int> places_on_sides(int order);
/// Returns for each point whether it is the node in the middle of a quad of order 2.
std::vector<char> are_in_middles(const Mesh& mesh);

/// The code of a format for elements of a shape with this number of nodes.
template <class Code>
struct CellCode {
  CellShape shape;
  std::size_t n_nodes;
  Code code;
  std::string_view order = {};  ///< places of the nodes, one digit each; empty: as here
};
/// Returns the row of a block, which must be listed.
template <class Code, std::size_t N>
const CellCode<Code>& row_of(const CellBlock& cells, const CellCode<Code> (&codes)[N]) {
  return *std::ranges::find_if(
      codes, [&](const CellCode<Code>& c) { return c.shape == cells.shape && c.n_nodes == cells.n_nodes; });
}
template <class Code, std::size_t N>
const Code& code_of(const CellBlock& cells, const CellCode<Code> (&codes)[N]) {
  return row_of(cells, codes).code;
}
/// Returns the nodes of an element in the order of a format.
template <class Code, std::size_t N>
std::vector<int> nodes_of(const CellBlock& cells, std::size_t i, const CellCode<Code> (&codes)[N]) {
  const std::vector<int> nodes = cells.nodes(i);
  const std::string_view order = row_of(cells, codes).order;
  std::vector<int> ordered;
  for (const char digit : order) ordered.push_back(nodes[static_cast<std::size_t>(digit - '0')]);
  return order.empty() ? nodes : ordered;
}

/// Returns the element and side of a half-edge.
CellSide cell_side(const Mesh& mesh, const HalfEdge& edge);

/// Completes the faces of cells that were read; does nothing to other meshes. Faces on the boundary look
/// outwards, and missing ones are added in a region without a name. Triangles and quads that are no sides of
/// cells go, which a note tells. All elements become straight. Throws InputError, with the place, for a side
/// of three cells.
void complete_faces(Mesh& mesh, ReadNotes* notes);

/// The sides of triangles and quads, or of cells if there are any.
class CellSides {
 public:
  explicit CellSides(const Mesh& mesh);
  /// Returns the sides on a line, or beside cells on a face, triangles first. There is one on the boundary,
  /// else two, in the order of the elements.
  std::vector<CellSide> at(int item) const;

 private:
  const Mesh& mesh_;
  std::vector<HalfEdge> of_faces_;
  std::vector<SolidSide> of_cells_;
};

/// Writes a line with the coordinates of each point, then a line for each triangle and quad: the number of
/// its corners, and their indices.
void write_points_and_faces(TextWriter& out, const Mesh& mesh);

std::vector<Entity> entities_of(const std::vector<NamedPoint>& points);

/// Points, lines or elements of one name, for formats that need one for everything.
struct MeshGroup {
  int dim;                  ///< 0: points, 1: lines, 2: triangles and quads, 3: cells
  int number;               ///< from 1 on, in each dimension
  std::string name, label;  ///< the label is the name as the format can hold it
  /// Indices of points, of lines, or of elements, triangles first.
  std::vector<int> items;
};

/// Returns groups of all named points, of lines on the boundary and named lines inside (all lines beside
/// cells), and of all elements. Groups of the highest dimension come first. Entities have the names of
/// group_names().
std::vector<MeshGroup> mesh_groups(const Mesh& mesh, const UniqueLabels::Rules& rules);
/// Returns the nodes of a group, ascending, each once.
std::vector<int> nodes_of_group(const Mesh& mesh, const MeshGroup& group);
/// Returns the number of the group of each item of a dimension; 0: none.
std::vector<int> group_numbers(const Mesh& mesh, const std::vector<MeshGroup>& groups, int dim);
/// Returns the indices in a block of the elements of a group.
std::vector<std::size_t> items_in_block(const MeshGroup& group, const CellBlock& cells);

/// Returns "curve "Ein|aus" is Ein_aus" for each group whose label differs from its name.
std::vector<std::string> renamed_groups(const std::vector<MeshGroup>& groups);

}  // namespace delquad
