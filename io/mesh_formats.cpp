#include <algorithm>
#include <limits>
#include <map>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/metrics.h"

namespace delquad {

namespace {

[[noreturn]] void unknown(const std::filesystem::path& path, const char* known) {
  throw InputError(path.string() + ": unknown kind of mesh file '" + path.extension().string() +
                   "': expected " + known);
}

void write_vtu_with_eta(const std::filesystem::path& path, const Mesh& mesh) {
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}});
}

/// A plane mesh is seen from above, one in space from a corner.
void write_picture(const std::filesystem::path& path, const Mesh& mesh) {
  const bool planar = std::all_of(mesh.points.begin(), mesh.points.end(),
                                  [&](const Vec3& p) { return p.z == mesh.points[0].z; });
  (planar ? draw_mesh : draw_surface)(path, mesh, path.stem().string());
}

constexpr const char* kMsh = ".msh";
using Writer = void (*)(const std::filesystem::path&, const Mesh&);

/// Of all formats without options.
const std::map<std::string, Writer>& writers() {
  static const std::map<std::string, Writer> all = {{".vtu", write_vtu_with_eta},
                                                    {".obj", write_obj},
                                                    {".inp", write_inp},
                                                    {".mesh", write_medit},
                                                    {".svg", write_picture}};
  return all;
}

/// kind_of_file() looks behind .gz, but nothing is written packed.
std::string kind_to_write(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return kind_of_file("x" + path.extension().string()) == kind ? kind : ".gz";
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, ReadNotes* notes) {
  const std::string kind = kind_of_file(path);
  if (kind == kMsh) return read_msh(path);
  if (kind == ".obj") return read_obj(path, notes);
  if (kind == ".off") return read_off(path, notes);
  if (kind == ".stl") return read_stl(path);
  if (kind == ".ply") return read_ply(path, notes);
  if (kind == ".3mf") return read_3mf(path, notes);
  if (kind == ".vtu") return read_vtu(path);
  if (kind == ".inp") return read_inp(path);
  if (kind == ".mesh") return read_medit(path);
  unknown(path, ".msh, .obj, .off, .stl, .ply, .3mf, .vtu, .inp or .mesh");
}

void check_mesh_format(const std::filesystem::path& path, const MshOptions& options) {
  const std::string kind = kind_to_write(path);
  if (kind == kMsh) return;
  if (!writers().count(kind)) unknown(path, ".msh, .vtu, .obj, .inp, .mesh or .svg");
  if (options.binary)
    throw InputError(path.string() + ": '" + kind + "' has no binary form here: expected .msh with --binary");
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  check_mesh_format(path, options);
  const std::string kind = kind_to_write(path);
  if (kind == kMsh) return write_msh(path, mesh, options);
  writers().at(kind)(path, mesh);
}

}  // namespace delquad
