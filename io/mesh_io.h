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

/// Returns where a file lies that is reached by symbolic links, whether it exists or not. Throws InputError
/// for links in a circle.
std::filesystem::path behind_links(std::filesystem::path path);

/// Writes a file whole or not at all: `write` fills a temporary file beside it, which is then renamed.
/// A link stays and its target is replaced; devices and pipes are written to directly. Throws InputError
/// naming the path and the system's reason (folder missing, not writable, disk full); what `write` throws
/// passes through.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(std::ostream&)>& write);
/// Writes a text in the same way.
void write_text_file(const std::filesystem::path& path, std::string_view text);
void write_text_file(const std::filesystem::path& path, const std::function<void(TextWriter&)>& write);

/// Several files that belong together: each is filled before the first gets its place, then they get theirs
/// in this order.
struct FileToWrite {
  std::filesystem::path path;
  std::function<void(std::ostream&)> write;
};
void write_files_atomically(const std::vector<FileToWrite>& files);

/// Removes the temporary files of write_file_atomically(), for a process that is about to end; safe in signal
/// handlers.
void remove_unfinished_files() noexcept;
/// Does the same, and keeps every file from getting its place from now on: the process must end next. False,
/// and nothing happens, once a file got its place.
bool abandon_files();

/// Returns the path's extension in small letters, such as ".stl"; for "part.STL.gz" it is ".stl", too.
std::string kind_of_file(const std::filesystem::path& path);

/// Returns whether a name can stand in an MSH file: it has no double quote and no line break.
bool fits_msh(std::string_view name);

/// Treatment of numbers that can hardly be coordinates: values that are not finite, and stray points
/// (geometry/mesh/stray_points.h).
enum class Strays {
  kRefused,  ///< InputError with their place
  kKept,     ///< for a caller who leaves them out; the greatest number stands for one that is not finite
};

/// Reads a mesh as read_mesh() does and keeps strays, in formats of triangles alone.
Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes, Strays strays);

// All readers unpack files that are compressed by gzip. They refuse a file that holds another format than its
// name says, or more or fewer elements than its header.

/// A number at each point of a mesh.
struct NodalValues {
  Mesh mesh;
  std::vector<double> values;
};

/// Reads the field `name`. An MSH file has it as a view ($NodeData or $ElementData), a VTU file as an array
/// of PointData or CellData. A SOL file of Medit (Mmg), or an MTR or METRIC file of BAMG, has values at the
/// points of the .mesh file beside it. Without a name, reads the only field. Values of elements become means,
/// by area, of the elements at a point. If there are several steps in time, reads the last one. Throws
/// InputError for a missing field, naming the others, for a field that has no numbers, and for points without
/// a value.
NodalValues read_values(const std::filesystem::path& path, const std::string& name);
/// Returns the same of tensors: xx, xy, xz, yy, yz and zz of each point. They come from MSH fields of 3 x 3
/// numbers, and from SOL and BAMG files. VTU arrays of 3 (xx, yy, xy), 4, 6 or 9 numbers hold them, too.
/// Tensors of the plane have no z, and zz = 1.
NodalValues read_tensors(const std::filesystem::path& path, const std::string& name);

/// Numbers at each point of a mesh, or of each of its triangles, then quads: so many side by side. NaN: there
/// is none. If there are hexahedra, numbers are of these.
struct MeshField {
  std::string name;
  bool is_of_points;
  int n_components;
  std::vector<double> values;
};
struct MeshWithFields {
  Mesh mesh;
  std::vector<MeshField> fields;
};
/// Reads all fields of an MSH or VTU file. If there are several steps in time, reads the last one. Points
/// that no element uses stay. Throws InputError for quads of 8 nodes, and MSH fields of more than 9
/// components.
MeshWithFields read_fields(const std::filesystem::path& path);
/// Writes MSH or VTU with fields, whole or not at all.
void write_fields(const std::filesystem::path& path, const Mesh& mesh, const std::vector<MeshField>& fields,
                  const MshOptions& options = {});
/// Returns whether it reads files of that name.
bool holds_values(const std::filesystem::path& path);

/// Throws InputError for an extension that write_mesh() does not know, with the known ones. It also throws
/// if the format has no such option, no elements of that order, or no quads.
void check_mesh_format(const std::filesystem::path& path, const MshOptions& options = {}, int order = 1,
                       bool has_quads = false);

/// Throws InputError when no hexahedra are written there, naming the formats that have them.
void check_hex_format(const std::filesystem::path& path, const MshOptions& options);

/// Throws InputError when write_mesh() takes no depths there, naming the formats that do.
void check_depths(const std::filesystem::path& path);

/// Writes a mesh as write_mesh() does, with quads of eight nodes: of order 2, in formats that have them.
void write_serendipity(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});
/// Throws InputError where write_serendipity() would throw one.
void check_serendipity(const std::filesystem::path& path, const MshOptions& options, int order);

/// Names that write_mesh() changes without telling in the file, whose format has no comments: "curve "a/b" is
/// a_b", one line each.
std::vector<std::string> renamed_in_file(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace delquad
