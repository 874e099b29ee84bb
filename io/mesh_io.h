// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/model.h"

// This header reads and writes meshes, fields and files. Most modules use it.

namespace delquad {

class TextWriter;

/// Returns the target of symbolic links, which need not exist. Throws InputError for links in a circle.
std::filesystem::path behind_links(std::filesystem::path path);

/// Writes a file completely or not at all: `write` fills a temporary file beside it, which is then renamed. A
/// link stays and its target is replaced; devices and pipes are written to directly. Throws InputError with
/// the path and the reason of the system (folder missing, not writable, disk full). Exceptions of `write`
/// pass through.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(std::ostream&)>& write);
/// Writes a text in the same way.
void write_text_file(const std::filesystem::path& path, std::string_view text);
void write_text_file(const std::filesystem::path& path, const std::function<void(TextWriter&)>& write);

/// A file of a group: all are filled before the first gets its place, then they get theirs in order.
struct FileToWrite {
  std::filesystem::path path;
  std::function<void(std::ostream&)> write;
};
void write_files_atomically(const std::vector<FileToWrite>& files);

/// Removes the temporary files of write_file_atomically() before the process ends; safe in signal handlers.
void remove_unfinished_files() noexcept;
/// Does the same, and lets no further file get its place: the process must end next. Returns false, and does
/// nothing, once a file got its place.
bool abandon_files();

/// Returns the extension of a path in small letters, without ".gz": ".stl" for "part.STL.gz".
std::string kind_of_file(const std::filesystem::path& path);

/// Returns whether a name can stand in an MSH file: it has no double quote and no line break.
bool fits_msh(std::string_view name);

/// Treatment of unlikely coordinates: numbers that are not finite, and stray points
/// (geometry/mesh/stray_points.h).
enum class Strays {
  kRefused,  ///< InputError with their place
  kKept,     ///< for a caller who removes them; the greatest number replaces infinity and NaN
};

/// Reads a mesh as read_mesh(), and treats strays, in formats of triangles only.
Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes, Strays strays);

// All readers unpack gzip. They throw InputError for a file of another format than its name, or with more or
// fewer elements than its header.

/// Numbers at each point of a mesh: one, or six for tensors.
struct NodalValues {
  Mesh mesh;
  std::vector<double> values;
};

/// Reads the field `name`; without a name the only one. An MSH file has it as a view ($NodeData or
/// $ElementData), a VTU file as an array of PointData or CellData. A SOL file of Medit (Mmg), or an MTR or
/// METRIC file of BAMG, has values at the points of the .mesh file beside it. Values of elements are averaged
/// at points, by area. The last of several time steps counts. Throws InputError for a missing field, with the
/// existing ones, for other forms of values, and for points without a value.
NodalValues read_values(const std::filesystem::path& path, const std::string& name);
/// Returns the same for tensors: xx, xy, xz, yy, yz and zz of each point. MSH fields of 3 x 3 numbers, SOL
/// and BAMG files, and VTU arrays of 3 (xx, yy, xy), 4, 6 or 9 hold them. Tensors of the plane have no z, and
/// zz = 1.
NodalValues read_tensors(const std::filesystem::path& path, const std::string& name);

/// Numbers at each point of a mesh, or at each of its triangles, then quads. NaN: no value.
struct MeshField {
  std::string name;
  bool is_of_points;
  int n_components;  ///< numbers of each item, one after the other
  std::vector<double> values;
};
struct MeshWithFields {
  Mesh mesh;
  std::vector<MeshField> fields;
};
/// Reads all fields of an MSH or VTU file; the last of several time steps counts. Unused points stay. Throws
/// InputError for quads of 8 nodes, and for MSH fields of more than 9 components.
MeshWithFields read_fields(const std::filesystem::path& path);
/// Writes MSH or VTU with fields, completely or not at all. Throws InputError as write_mesh().
void write_fields(const std::filesystem::path& path, const Mesh& mesh, const std::vector<MeshField>& fields,
                  const MshOptions& options = {});
/// Returns whether read_values() reads files of that name.
bool holds_values(const std::filesystem::path& path);

/// Throws InputError for an extension that write_mesh() does not know, with the known ones. Also throws if
/// the format lacks an option, elements of that order, or quads.
void check_mesh_format(const std::filesystem::path& path, const MshOptions& options = {}, int order = 1,
                       bool has_quads = false, bool may_have_cells = false);

/// Throws InputError if the format has no cells of volumes, or no pyramids but the mesh has some, with the
/// formats that have them.
void check_cell_format(const std::filesystem::path& path, const MshOptions& options, const Mesh& mesh = {});

/// Throws InputError if the format has no depths, with the formats that have them.
void check_depths(const std::filesystem::path& path);

/// Writes a mesh as write_mesh(), with quads of order 2 and eight nodes. Throws InputError as
/// check_serendipity().
void write_serendipity(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});
/// Throws InputError for a format without quads of eight nodes, or another order.
void check_serendipity(const std::filesystem::path& path, const MshOptions& options, int order);

/// Returns names that write_mesh() changes without a comment in the file, one line each: "curve "a/b" is
/// a_b".
std::vector<std::string> renamed_in_file(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace delquad
