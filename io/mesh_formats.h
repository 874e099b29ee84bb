// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "io/entity_names.h"
#include "io/formats/shell_sections.h"
#include "io/mesh_io.h"

// This header lists the formats of meshes. The program, readers and writers and the Python module use it.

namespace delquad {

/// Whether a format has quads of eight nodes; kAlways: quads of order 2 have no other form.
enum class EightNodes { kNever, kOnRequest, kAlways };

/// Bits for the kinds of names that a format holds, and for pairs.
enum NameKinds : unsigned {
  kRegionNames = 1,
  kInnerNames = 2,
  kBoundaryNames = 4,
  kPointNames = 8,
  kAllNames = 15,
  kFurtherNames = 16,  ///< all names of regions and curves, not only group_names()
  kPeriodicPairs = 32  ///< nodes that are images of others
};

/// A kind of mesh file. Its code is in its files in io/formats/ and in a line of mesh_formats.cpp.
struct MeshFormat {
  std::vector<std::string> extensions;  ///< in small letters, with the dot; the usual one first
  std::string description;
  Mesh (*read)(const std::filesystem::path&, ReadNotes*, Strays) = nullptr;  ///< null: it is not read
  void (*write)(const std::filesystem::path&, const Mesh&, const MshOptions&) = nullptr;
  int most_order = 1;        ///< of elements that are written
  std::string package = {};  ///< Debian package of the missing library; empty: nothing is missing
  bool has_faces = true;     ///< triangles and quads without cells
  bool has_cells = false;    ///< of volumes
  bool has_pyramids = true;  ///< if it has cells
  bool has_shells = false;   ///< triangles and quads are shells, even in a plane
  EightNodes eight_nodes = EightNodes::kNever;
  bool has_binary = false;
  bool has_depths = false;      ///< z of a planar mesh may be the height of the ground
  bool has_open_sides = false;  ///< sides may be open to water, by their names
  /// Labels of mesh_groups(), or a function, for renamed_in_file(); both null if the file itself lists new
  /// names.
  const UniqueLabels::Rules* labels = nullptr;
  std::vector<std::string> (*renamed)(const Mesh&) = nullptr;
  unsigned names = kAllNames;                  ///< bits of NameKinds
  std::vector<std::string> of_triangles = {};  ///< extensions of files that have no quads
  /// Reads and rewrites files whose other contents stay, see read_given_mesh() and rewrite_mesh(); null: none
  /// stay.
  Mesh (*read_given)(const std::filesystem::path&, ReadNotes*) = nullptr;
  void (*rewrite)(const std::filesystem::path& source, const std::filesystem::path&, const Mesh&,
                  double weld) = nullptr;
  /// Sections of shells, see carry_sections(); null: files hold none.
  ShellSections (*sections)(const std::filesystem::path&) = nullptr;
  void (*add_sections)(const std::filesystem::path&, const Mesh&, ShellSections&) = nullptr;
  /// See ignored_keywords(); null: there is nothing.
  std::map<std::string, int> (*others)(const std::filesystem::path&) = nullptr;
};

/// Adapts readers without notes.
template <Mesh (*read)(const std::filesystem::path&)>
Mesh read_by(const std::filesystem::path& path, ReadNotes*, Strays) {
  return read(path);
}
/// Adapts writers without options.
template <void (*write)(const std::filesystem::path&, const Mesh&)>
void write_by(const std::filesystem::path& path, const Mesh& mesh, const MshOptions&) {
  write(path, mesh);
}

/// Returns the values that MshOptions::element may have for cells. Types with 20 and 10 nodes have nodes in
/// the middle of edges; other shapes get types of the same order.
const std::vector<std::string>& inp_cells();
/// Returns whether elements of a type have nodes in the middle of edges.
bool has_middle_nodes(const std::string& element);
/// The value for shells, even in a plane.
inline constexpr const char* kShell = "S4";
/// Returns the options for a mesh from this source: its shells stay shells in .inp.
MshOptions options_for_source(const std::filesystem::path& source, MshOptions options);

/// Returns whether this program, or one with the missing library, can write a format.
bool can_write(const MeshFormat& format);

/// Returns the formats in the order of the documentation.
const std::vector<MeshFormat>& mesh_formats();

/// Reads a mesh to improve, with the regions and points that rewrite_mesh() needs. Throws InputError as
/// read_mesh().
Mesh read_given_mesh(const std::filesystem::path& path, ReadNotes* notes = nullptr);
/// Returns whether the other contents of `source` stay in `path`: both are decks of Abaqus or CalculiX, or
/// both of Nastran.
bool keeps_file(const std::filesystem::path& source, const std::filesystem::path& path);
/// Writes the source again, with a mesh from read_given_mesh() or stages after it. Everything else stays:
/// types, numbers, sets, sections, loads. `weld` is the share of the diagonal within which weld_open_edges()
/// joined points. Throws InputError if a line names a removed item.
void rewrite_mesh(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                  double weld);
/// Adds the sections of a deck to the deck of another program that write_mesh() wrote, if both formats have
/// sections. Returns lost contents of the source, one line each, including ignored_keywords().
std::vector<std::string> carry_sections(const std::filesystem::path& source,
                                        const std::filesystem::path& path, const Mesh& mesh);
/// Returns the keywords of a file that are no part of a mesh, with counts: "*CLOAD (2), *MATERIAL (1)".
/// `carried` ones are left out.
std::string ignored_keywords(const std::filesystem::path& path,
                             const std::map<std::string, int>& carried = {});

/// Returns the highest order of elements that write_mesh() writes there. Throws as check_mesh_format().
int most_order_of(const std::filesystem::path& path);
/// Returns the mesh of its corners, of order 1.
Mesh straightened(Mesh mesh);
/// Returns the parts of a mesh that a file of that name cannot hold, one line each: names, and a higher
/// order.
std::vector<std::string> unsupported_in_file(const std::filesystem::path& path, const Mesh& mesh);
/// Returns one line, with the remedy, for missing depths and for a missing open side, if programs need them.
/// `gets_depths` tells that depths come later.
std::vector<std::string> missing_in_file(const std::filesystem::path& path, const Mesh& mesh,
                                         bool gets_depths = false);

}  // namespace delquad
