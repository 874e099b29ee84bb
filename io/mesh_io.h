#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/model.h"

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
/// The same, and keeps every file from getting its place from now on: the process must end next. False, and
/// nothing happens, once a file got its place.
bool abandon_files();

/// The path's extension in small letters, such as ".stl"; for "part.STL.gz" it is ".stl", too.
std::string kind_of_file(const std::filesystem::path& path);

/// Whether a name can stand in an MSH file: it has no double quote and no line break.
bool fits_msh(std::string_view name);

/// What readers of triangles do with numbers that can hardly be coordinates: those that are not finite, and
/// stray points (geometry/mesh/stray_points.h).
enum class Strays {
  kRefused,  ///< InputError with their place
  kKept,     ///< for a caller who leaves them out; the greatest number stands for one that is not finite
};

/// read_mesh() that keeps strays, in formats of triangles alone.
Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes, Strays strays);

// All readers unpack files that are compressed by gzip, and refuse one that holds another format than its
// name says, or more or fewer elements than its header.

/// Reads MSH 2.2 or 4.1, text or binary, by content. Elements of dimension 1 and 2 become lines, triangles
/// and quads, curved ones of one order; physical names and entity tags are kept (a group without a name goes
/// by its number), and so are the further names that write_msh() leaves; points are ignored, and so are nodes
/// that no other element uses. `notes` tells of periodic pairs, which are not read. Throws InputError with
/// file and line, or byte.
Mesh read_msh(const std::filesystem::path& path, DeclaredSurfaces* surfaces = nullptr,
              ReadNotes* notes = nullptr);
/// Reads Wavefront OBJ: v, l, f; g names the region of the faces and the curve of the lines after it. Faces
/// of more than four vertices are split into triangles. In a file of the plane all points have two
/// coordinates.
Mesh read_obj(const std::filesystem::path& path, ReadNotes* notes = nullptr,
              Strays strays = Strays::kRefused);
/// Reads Object File Format, text or binary, with or without colours and normals, which are ignored. Faces of
/// more than four vertices are split into triangles.
Mesh read_off(const std::filesystem::path& path, ReadNotes* notes = nullptr,
              Strays strays = Strays::kRefused);

/// Reads STL, text or binary, by content. Points with the same coordinates become one. Each solid of a text
/// file is a region with its name.
Mesh read_stl(const std::filesystem::path& path, ReadNotes* notes = nullptr,
              Strays strays = Strays::kRefused);

/// Reads the Polygon File Format (Stanford), text or binary of either byte order. Faces of one colour are a
/// region with its name ("colour #rrggbb"), unless there are more than 64 colours; other properties are left
/// out. Faces of more than four vertices are split into triangles.
Mesh read_ply(const std::filesystem::path& path, ReadNotes* notes = nullptr,
              Strays strays = Strays::kRefused);
/// Reads 3MF: what the model's build holds, from whatever file of the archive, in its unit. Each object is a
/// region with its name, or one for each of its colours, unless there are more than 64. Throws InputError
/// with the line of the model inside.
Mesh read_3mf(const std::filesystem::path& path, ReadNotes* notes = nullptr,
              Strays strays = Strays::kRefused);

/// Reads VTK XML of an unstructured grid: lines, triangles and quads; arrays as text or base64, inline or
/// appended (raw, too), plain or compressed by zlib. Curves, regions and names are those of write_vtu();
/// files of other programs have one curve and one region.
Mesh read_vtu(const std::filesystem::path& path);
/// Reads Abaqus input: *NODE, *ELEMENT of two to four or eight nodes (shells, membranes, plane ones, bars),
/// *ELSET. Element sets become names of regions, unless their own begins with an underscore; surfaces of
/// elements' sides (S1 to S4, E1 to E4) become curves. Other keywords are left out.
Mesh read_inp(const std::filesystem::path& path);
/// Reads Medit text: references are tags of curves and regions, names are those that write_medit() leaves in
/// comments. A file that shows to be one of MFEM is read as such.
Mesh read_medit(const std::filesystem::path& path);

/// Reads unstructured cell data of AVS, as text: lines, triangles and quads; materials are tags of curves and
/// regions, names are those that write_ucd() leaves in comments; values are left out.
Mesh read_ucd(const std::filesystem::path& path);
/// Reads MFEM meshes v1.0 of dimension 2: attributes are tags, names those that write_mfem() leaves in
/// comments. Curved ones are of quads, their nodes those of H1 or of closed L2 elements up to kMostOrder;
/// nodes that elements have in common must lie at one place.
Mesh read_mfem(const std::filesystem::path& path);
/// Reads Nastran's bulk data, in free, small and large fields: GRID, CQUAD4, CQUAD8, CTRIA3, and as lines
/// CBAR, CBEAM, CROD, CTUBE, CONROD and PLOTEL. Properties are tags, names those that write_nastran() leaves
/// in comments. Nodes must be in the basic coordinate system. Other cards are left out.
Mesh read_nastran(const std::filesystem::path& path);

/// A number at each point of a mesh.
struct NodalValues {
  Mesh mesh;
  std::vector<double> values;
};

/// Reads the field `name` of an MSH file (a view: $NodeData or $ElementData) or a VTU file (an array of
/// PointData or CellData); without a name the only one that there is. Values of elements become means, by
/// area, of the elements at a point. Of several steps in time it is the last one. Throws InputError where
/// there is none, naming those that there are, where it is no field of numbers, and where points have none.
NodalValues read_values(const std::filesystem::path& path, const std::string& name);
/// Whether it reads files of that name.
bool holds_values(const std::filesystem::path& path);

/// Which nodes of quads of order 2 are written: nine, or eight of a mesh in which a corner stands for the
/// middle one.
enum class QuadNodes { kAll, kNoMiddle };

/// MSH 4.1 with $PhysicalNames and $Entities. Coordinates read back exactly. Each entity is in exactly one
/// physical group, for meshio, dolfinx and deal.II take no other files: that of group_names(). Names beside
/// it follow the elements in a section $MoreNames, which other programs skip. A group whose name is a number
/// gets that number as its tag. The unit of lengths, where it is known, is a section $Unit after these.
void write_msh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {},
               QuadNodes nodes = QuadNodes::kAll);
void write_msh(std::ostream& stream, const Mesh& mesh, const MshOptions& options = {},
               QuadNodes nodes = QuadNodes::kAll);
/// VTK XML (base64). Each cell has the tag of its curve or its region (arrays `curve` and `region`; 0: none),
/// and one value per cell (lines, then triangles, then quads) for each field in `cell_data`; a NaN there
/// means that the cell has no value. Names are field data: an array "curve NAME" or "region NAME" lists the
/// tags. A known unit of lengths is a comment, here and in OBJ, Abaqus input and Medit text.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data = {},
               QuadNodes nodes = QuadNodes::kAll);
/// Wavefront OBJ; names of curves and regions become groups, their white space underscores; names that would
/// be one then get numbers, and comments say so.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);
/// Abaqus input, as CalculiX takes it, too: numbers of at most 20 characters, shells S4 and S3, or CPS4 and
/// CPS3 when all z are equal and elements turn left. Every region is an ELSET and an NSET, every curve an
/// NSET and a SURFACE, by its tag ("region_3", "curve_5") and by each of its names, as far as Abaqus takes
/// them (letters, digits, underscores); comments have the table. Of plane elements a curve's surface has the
/// sides, of shells the nodes, and the sides are ELSETs for edge loads ("_curve_5_E2").
void write_inp(const std::filesystem::path& path, const Mesh& mesh);
/// VTK's older format, as text. Cells have tags as in VTU; names are field arrays "region_NAME" of tags.
void write_vtk(const std::filesystem::path& path, const Mesh& mesh);
/// What becomes of names there, as renamed_in_file() tells it.
std::vector<std::string> renamed_in_vtk(const Mesh& mesh);
std::vector<std::string> renamed_in_msh(const Mesh& mesh);
/// Unstructured cell data of AVS, as deal.II reads it, too: the material of a cell is the number of its name,
/// which comments tell.
void write_ucd(const std::filesystem::path& path, const Mesh& mesh);
/// SU2's own format, of planar meshes: a marker for each name of the boundary.
void write_su2(const std::filesystem::path& path, const Mesh& mesh);
/// MFEM's own format (1.0): attributes are the numbers of names, which comments tell.
void write_mfem(const std::filesystem::path& path, const Mesh& mesh);
/// Nastran's bulk data: CQUAD4, CQUAD8 and CTRIA3, a property for each name of regions, SETs of the nodes of
/// curves and points; comments tell the names.
void write_nastran(const std::filesystem::path& path, const Mesh& mesh);
/// LS-DYNA's keywords: shells, a part for each name of regions, node sets of curves and points, all with
/// their titles.
void write_ls_dyna(const std::filesystem::path& path, const Mesh& mesh);
/// Exodus II: a block for each name of regions, node and side sets of curves, node sets of points.
void write_exodus(const std::filesystem::path& path, const Mesh& mesh);
/// CGNS: one zone, a section for each name of regions and curves, boundary conditions on curves and points.
void write_cgns(const std::filesystem::path& path, const Mesh& mesh);
/// MED 4: a family and a group for each name.
void write_med(const std::filesystem::path& path, const Mesh& mesh);
/// XDMF 3, the numbers in an HDF5 file of the same name beside it; grids "mesh" (quads), "triangles" and
/// "lines" with the numbers of names, which are Information elements.
void write_xdmf(const std::filesystem::path& path, const Mesh& mesh);
/// Medit text (version 2): the references are tags of curves and regions; names stand in comments.
void write_medit(const std::filesystem::path& path, const Mesh& mesh);
/// InputError when write_mesh() knows no format for the path's extension, naming those known, or the format
/// has no such option, or no elements of that order.
void check_mesh_format(const std::filesystem::path& path, const MshOptions& options = {}, int order = 1);

/// write_mesh() with quads of eight nodes: of order 2, in formats that have them.
void write_serendipity(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});
/// InputError where write_serendipity() would throw one.
void check_serendipity(const std::filesystem::path& path, const MshOptions& options, int order);

/// Names that write_mesh() changes without telling in the file, whose format has no comments: "curve "a/b" is
/// a_b", one line each.
std::vector<std::string> renamed_in_file(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace delquad
