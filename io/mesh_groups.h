#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"
#include "io/entity_names.h"

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
/// The nodes of a group of points or lines (dimensions 0 and 1), ascending, each once.
std::vector<int> nodes_of_group(const Mesh& mesh, const MeshGroup& group);
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

/// Throws InputError where there are more of something than numbers that a format can hold.
void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most);
/// Nodes, and lines, triangles and quads together, are numbered from 1.
void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most);

/// A name in one line.
std::string one_line_label(const std::string& name);
/// A name for CGNS, where it has no slash.
std::string cgns_label(const std::string& name);
/// A name for MED, whose readers take letters of other alphabets in several ways.
std::string ascii_label(const std::string& name);
/// Labels of formats that have no comments to tell what was renamed. Of CGNS names have at most 32
/// characters, of MED 80 bytes, of Exodus as many as the file says.
inline constexpr UniqueLabels::Rules kExodusLabels{one_line_label, false, 70};
inline constexpr UniqueLabels::Rules kCgnsLabels{cgns_label, false, 22};
inline constexpr UniqueLabels::Rules kMedLabels{ascii_label, false, 70};
/// A name of letters, digits and underscores that begins with a letter.
std::string plain_label(const std::string& name);

}  // namespace delquad
