#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/mesh.h"

namespace delquad {

/// Where a file lies that is reached by symbolic links, whether it exists or not. Throws InputError for links
/// in a circle.
std::filesystem::path behind_links(std::filesystem::path path);

/// Writes a file whole or not at all: `write` fills a temporary file beside it, which is then renamed.
/// A link stays and its target is replaced; devices and pipes are written to directly. Throws InputError
/// naming the path and the system's reason (folder missing, not writable, disk full); what `write` throws
/// passes through.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(std::ostream&)>& write);

/// Removes the temporary files of write_file_atomically(), for a process that is about to end; safe in signal
/// handlers.
void remove_unfinished_files() noexcept;
/// The same, and keeps every file from getting its place from now on: the process must end next. False, and
/// nothing happens, once a file got its place.
bool abandon_files();

/// What an MSH file says of surfaces, whether it has elements on them or not.
struct MshSurfaces {
  std::vector<std::string> group_names;  ///< of the named groups of dimension 2
  struct Surface {
    Entity entity;
    std::vector<int> curves;  ///< tags of the curves that bound it, ascending
  };
  std::vector<Surface> surfaces;  ///< those that 4.1 lists with their curves
};

/// Whether a name can stand in an MSH file: it has no double quote and no line break.
bool fits_msh(std::string_view name);

/// Reads MSH 2.2 or 4.1 (text), by content. Elements of dimension 1 and 2 become lines, triangles and quads;
/// physical names and entity tags are kept (a group without a name goes by its number); points are ignored,
/// and so are nodes that no other element uses. Throws InputError with file and line.
Mesh read_msh(const std::filesystem::path& path, MshSurfaces* surfaces = nullptr);
/// Reads Wavefront OBJ: v, l, f (3 or 4 vertices); g names the region of the faces and the curve of the lines
/// after it.
Mesh read_obj(const std::filesystem::path& path);
/// Reads Object File Format text, with or without colours and normals, which are ignored: faces of 3 or 4
/// vertices.
Mesh read_off(const std::filesystem::path& path);

/// Reads STL, text or binary, by content. Points with the same coordinates become one. Each solid of a text
/// file is a region with its name.
Mesh read_stl(const std::filesystem::path& path);

/// Reads by extension: .msh, .obj, .off, .stl. InputError for any other, naming those known.
Mesh read_mesh(const std::filesystem::path& path);

/// MSH 4.1 text with $PhysicalNames and $Entities. Coordinates read back exactly. A group whose name is a
/// number gets that number as its tag.
void write_msh(const std::filesystem::path& path, const Mesh& mesh);
void write_msh(std::ostream& stream, const Mesh& mesh);
/// VTK XML (base64), with the tag of its entity for each cell and one value per cell (lines, then triangles,
/// then quads) for each field in `cell_data`; a NaN there means that the cell has no value.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data = {});
/// Wavefront OBJ; names of curves and regions become groups, their white space underscores.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);
/// Abaqus input: shells S4 and S3, or CPS4 and CPS3 when all z are equal. Regions are ELSETs and NSETs,
/// curves NSETs, by their names as far as Abaqus takes them (letters, digits, underscores), else "region_" or
/// "curve_" and the tag.
void write_inp(const std::filesystem::path& path, const Mesh& mesh);
/// Medit text (version 2): the references are tags of curves and regions; names stand in comments.
void write_medit(const std::filesystem::path& path, const Mesh& mesh);
/// InputError when write_mesh() knows no format for the path's extension, naming those known.
void check_mesh_format(const std::filesystem::path& path);
/// By extension: .msh, .vtu (with eta per quad), .obj, .inp, .mesh. Throws as check_mesh_format().
void write_mesh(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace delquad
