#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "io/entity_names.h"
#include "mesh/half_edges.h"

namespace delquad {

/// Points, lines or elements of one name, for formats in which everything has one.
struct MeshGroup {
  int dim;                  ///< 0: points, 1: lines, 2: triangles and quads
  int number;               ///< from 1 on, in each dimension
  std::string name, label;  ///< the label is the name as the format can hold it
  /// Points; indices into Mesh::lines; elements, triangles first.
  std::vector<int> items;
};

/// All named points, the lines on the boundary and the named ones inside, all elements; those of dimension 2
/// first. Entities have the names of group_names().
std::vector<MeshGroup> mesh_groups(const Mesh& mesh, const UniqueLabels::Rules& rules);
/// The groups' numbers of all items of a dimension; 0: in none.
std::vector<int> group_numbers(const std::vector<MeshGroup>& groups, int dim, std::size_t n_items);

/// "curve "Ein|aus" is Ein_aus", one for each group whose label is not its name.
std::vector<std::string> renamed_groups(const std::vector<MeshGroup>& groups);

/// Side k of an element, between its corners k and k + 1.
struct ElementSide {
  int element, side;
};
/// The sides of elements that lie on a line, in the order of the elements. `sides`: sorted_half_edges().
std::vector<ElementSide> sides_at_line(const Mesh& mesh, std::span<const HalfEdge> sides, int line);

/// Whether all points have one z and the elements run counterclockwise as seen from above.
bool is_planar(const Mesh& mesh);

/// A name in one line.
std::string one_line_label(const std::string& name);
/// A name of letters, digits and underscores that begins with a letter.
std::string plain_label(const std::string& name);

}  // namespace delquad
