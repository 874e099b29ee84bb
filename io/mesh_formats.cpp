#include <algorithm>
#include <limits>

#include "io/mesh_io.h"
#include "mesh/error.h"
#include "metrics/metrics.h"

namespace delquad {

namespace {

std::string extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return text;
}

[[noreturn]] void unknown(const std::filesystem::path& path, const char* known) {
  throw InputError(path.string() + ": unknown kind of mesh file '" + path.extension().string() +
                   "': expected " + known);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const std::string kind = extension(path);
  if (kind == ".msh") return read_msh(path);
  if (kind == ".obj") return read_obj(path);
  if (kind == ".off") return read_off(path);
  if (kind == ".stl") return read_stl(path);
  unknown(path, ".msh, .obj, .off or .stl");
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  const std::string kind = extension(path);
  if (kind == ".msh") return write_msh(path, mesh);
  if (kind == ".obj") return write_obj(path, mesh);
  if (kind != ".vtu") unknown(path, ".msh, .vtu or .obj");
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}});
}

}  // namespace delquad
