#include "io/mesh_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>

#include "base/utf8.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "io/hex_writers.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/metrics.h"

namespace delquad {

namespace {

void write_vtu_with_eta(const std::filesystem::path& path, const Mesh& mesh, QuadNodes nodes) {
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}}, nodes);
}
void write_vtu_plainly(const std::filesystem::path& path, const Mesh& mesh) {
  write_vtu_with_eta(path, mesh, QuadNodes::kAll);
}

/// A plane mesh is seen from above, one in space from a corner.
void write_picture(const std::filesystem::path& path, const Mesh& mesh) {
  const bool planar = std::all_of(mesh.points.begin(), mesh.points.end(),
                                  [&](const Vec3& p) { return p.z == mesh.points[0].z; });
  (planar ? draw_mesh : draw_surface)(path, mesh, path.stem().string());
}

/// Readers that note nothing.
template <Mesh (*read)(const std::filesystem::path&)>
Mesh read_plainly(const std::filesystem::path& path, ReadNotes*, Strays) {
  return read(path);
}
Mesh read_msh_alone(const std::filesystem::path& path, ReadNotes* notes, Strays) {
  return read_msh(path, nullptr, notes);
}

/// Writers of hexahedra that have no binary form.
template <void (*write)(const std::filesystem::path&, const HexMesh&)>
void write_plainly(const std::filesystem::path& path, const HexMesh& mesh, bool) {
  write(path, mesh);
}

void make_utf8(Entity& entity) {
  for (std::string& name : entity.names) name = as_utf8(name);
}

/// What formats rename that have labels by these rules.
template <const UniqueLabels::Rules& rules>
std::vector<std::string> renamed_by(const Mesh& mesh) {
  return renamed_groups(mesh_groups(mesh, rules));
}

/// Of formats whose files do not tell what became of names, by extension.
const std::map<std::string, std::vector<std::string> (*)(const Mesh&)> kRenamed = {
    {".msh", renamed_in_msh},
    {".vtk", renamed_in_vtk},
    {".e", renamed_by<kExodusLabels>},
    {".cgns", renamed_by<kCgnsLabels>},
    {".med", renamed_by<kMedLabels>}};

constexpr const char* kMsh = ".msh";
/// Formats with quads of 8 nodes; of order 2 the last ones have no others.
constexpr std::array kWithEight = {kMsh, ".vtu", ".inp", ".bdf"};
constexpr std::array kAlwaysEight = {".inp", ".bdf"};

bool is_among(const MeshFormat& format, std::span<const char* const> extensions) {
  return std::ranges::find(extensions, format.extensions[0]) != extensions.end();
}

/// kind_of_file() looks behind .gz, but nothing is written packed.
std::string kind_to_write(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return kind_of_file("x" + path.extension().string()) == kind ? kind : ".gz";
}

const MeshFormat* find_format(const std::string& kind) {
  for (const MeshFormat& format : mesh_formats())
    if (std::ranges::find(format.extensions, kind) != format.extensions.end()) return &format;
  return nullptr;
}

/// ".msh, .vtu or .obj": the first extension of all formats that can do it.
template <class Can>
std::string extensions_of(const Can& can) {
  std::vector<std::string> all;
  for (const MeshFormat& format : mesh_formats())
    if (can(format)) all.push_back(format.extensions[0]);
  if (all.size() < 2) return fmt::format("{}", fmt::join(all, ""));
  const std::string last = all.back();
  all.pop_back();
  return fmt::format("{} or {}", fmt::join(all, ", "), last);
}

[[noreturn]] void unknown(const std::filesystem::path& path, const std::string& known) {
  throw InputError(path.string() + ": unknown kind of mesh file '" + path.extension().string() +
                   "': expected " + known);
}

#ifdef DELQUAD_HAS_EXODUS
constexpr const char* kExodusPackage = "";
#else
constexpr const char* kExodusPackage = "libexodusii-dev";
#endif
#ifdef DELQUAD_HAS_CGNS
constexpr const char* kCgnsPackage = "";
#else
constexpr const char* kCgnsPackage = "libcgns-dev";
#endif
#ifdef DELQUAD_HAS_MED
constexpr const char* kMedPackage = "";
#else
constexpr const char* kMedPackage = "libmedc-dev";
#endif
#ifdef DELQUAD_HAS_HDF5
constexpr const char* kHdf5Package = "";
#else
constexpr const char* kHdf5Package = "libhdf5-dev";
#endif

}  // namespace

bool can_write(const MeshFormat& format) { return format.write != nullptr || format.extensions[0] == kMsh; }

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> all = {
      {{kMsh}, "Gmsh 2.2 and 4.1, text or bytes", read_msh_alone, nullptr, kMostOrder, "", write_hex_msh},
      {{".vtu"},
       "VTK XML, ParaView",
       read_plainly<read_vtu>,
       write_vtu_plainly,
       kMostOrder,
       "",
       write_plainly<write_hex_vtu>},
      {{".obj"}, "Wavefront", read_obj, write_obj, 1},
      {{".inp"}, "Abaqus, CalculiX", read_plainly<read_inp>, write_inp, 2, "", write_plainly<write_hex_inp>},
      {{".mesh"}, "Medit", read_plainly<read_medit>, write_medit, 1},
      {{".vtk"}, "VTK legacy, text", nullptr, write_vtk, kMostOrder},
      {{".e", ".exo", ".ex2"}, "Exodus II: MOOSE, Cubit", nullptr, write_exodus, 2, kExodusPackage},
      {{".cgns"}, "CGNS", nullptr, write_cgns, 2, kCgnsPackage},
      {{".med"}, "MED: Code_Aster, Salome", nullptr, write_med, 2, kMedPackage},
      {{".xdmf"}, "XDMF with numbers in HDF5: dolfinx, ParaView", nullptr, write_xdmf, 2, kHdf5Package},
      {{".ucd", ".avs"}, "AVS unstructured cell data: deal.II", read_plainly<read_ucd>, write_ucd, 1},
      {{".mfem"}, "MFEM 1.0", read_plainly<read_mfem>, write_mfem, kMostOrder},
      {{".su2"}, "SU2", nullptr, write_su2, 1},
      {{".bdf", ".nas"}, "Nastran bulk data", read_plainly<read_nastran>, write_nastran, 2},
      {{".k", ".key"}, "LS-DYNA keywords", nullptr, write_ls_dyna, 1},
      {{".off"}, "Object File Format", read_off, nullptr, 1},
      {{".stl"}, "stereolithography", read_stl, nullptr, 1},
      {{".ply"}, "Polygon File Format", read_ply, nullptr, 1},
      {{".3mf"}, "3D Manufacturing Format", read_3mf, nullptr, 1},
      {{".svg"}, "a picture", nullptr, write_picture, kMostOrder},
  };
  return all;
}

Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes) {
  return read_mesh(path, notes, Strays::kRefused);
}

Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  const MeshFormat* format = find_format(kind_of_file(path));
  if (format == nullptr || format->read == nullptr)
    unknown(path, extensions_of([](const MeshFormat& f) { return f.read != nullptr; }));
  Mesh mesh = format->read(path, notes, strays);
  for (auto* entities : {&mesh.curves, &mesh.regions})
    for (Entity& entity : *entities) make_utf8(entity);
  for (NamedPoint& point : mesh.named_points) make_utf8(point.entity);
  return mesh;
}

void check_mesh_format(const std::filesystem::path& path, const MshOptions& options, int order) {
  const std::string kind = kind_to_write(path);
  const MeshFormat* format = find_format(kind);
  if (format == nullptr || !can_write(*format)) unknown(path, extensions_of(can_write));
  if (!format->package.empty())
    throw InputError(
        fmt::format("{}: this program was built without the library for '{}': install Debian's package {} "
                    "and build it again",
                    path.string(), kind, format->package));
  if (order > format->most_order)
    throw InputError(fmt::format(
        "{}: '{}' has no elements of order {} here: expected {}", path.string(), kind, order,
        extensions_of([&](const MeshFormat& f) { return can_write(f) && f.most_order >= order; })));
  if (kind != kMsh && options.binary)
    throw InputError(path.string() + ": '" + kind + "' has no binary form here: expected .msh with --binary");
}

void check_hex_format(const std::filesystem::path& path, bool binary) {
  const std::string kind = kind_to_write(path);
  const MeshFormat* format = find_format(kind);
  const auto can = [](const MeshFormat& f) { return f.write_hexahedra != nullptr; };
  if (format == nullptr) unknown(path, extensions_of(can));
  if (!can(*format))
    throw InputError(fmt::format("{}: '{}' is not written with hexahedra here: expected {}", path.string(),
                                 kind, extensions_of(can)));
  check_mesh_format(path, {binary, MshCurves::kAll});
}

void write_hexahedra(const std::filesystem::path& path, const HexMesh& mesh, bool binary) {
  check_hex_format(path, binary);
  find_format(kind_to_write(path))->write_hexahedra(path, mesh, binary);
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  check_mesh_format(path, options, mesh.order);
  const std::string kind = kind_to_write(path);
  if (kind == kMsh) return write_msh(path, mesh, options);
  find_format(kind)->write(path, mesh);
}

void check_serendipity(const std::filesystem::path& path, const MshOptions& options, int order) {
  check_mesh_format(path, options, order);
  if (order != 2)
    throw InputError(
        fmt::format("{}: quads of 8 nodes have order 2, these have order {}: expected --order 2 with "
                    "--serendipity",
                    path.string(), order));
  const std::string kind = kind_to_write(path);
  const auto can = [](const MeshFormat& f) { return is_among(f, kWithEight); };
  if (!can(*find_format(kind)))
    throw InputError(fmt::format("{}: '{}' has no quads of 8 nodes here: expected {}", path.string(), kind,
                                 extensions_of(can)));
}

void write_serendipity(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  check_serendipity(path, options, mesh.order);
  const std::string kind = kind_to_write(path);
  if (is_among(*find_format(kind), kAlwaysEight)) return write_mesh(path, mesh, options);
  Mesh eight = mesh;  // a corner stands for each middle node, which so is no node any more
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) eight.quad_nodes[5 * q + 4] = mesh.quads[q][0];
  drop_unused_points(eight);
  if (kind == kMsh) return write_msh(path, eight, options, QuadNodes::kNoMiddle);
  write_vtu_with_eta(path, eight, QuadNodes::kNoMiddle);
}

std::vector<std::string> renamed_in_file(const std::filesystem::path& path, const Mesh& mesh) {
  const MeshFormat* format = find_format(kind_to_write(path));
  const auto found = format == nullptr ? kRenamed.end() : kRenamed.find(format->extensions[0]);
  return found == kRenamed.end() ? std::vector<std::string>() : found->second(mesh);
}

}  // namespace delquad
