#include <algorithm>
#include <limits>
#include <map>

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

void write_vtu_with_eta(const std::filesystem::path& path, const Mesh& mesh) {
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}});
}

using Writer = void (*)(const std::filesystem::path&, const Mesh&);

const std::map<std::string, Writer>& writers() {
  static const std::map<std::string, Writer> all = {{".msh", write_msh},
                                                    {".vtu", write_vtu_with_eta},
                                                    {".obj", write_obj},
                                                    {".inp", write_inp},
                                                    {".mesh", write_medit}};
  return all;
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

void check_mesh_format(const std::filesystem::path& path) {
  if (!writers().count(extension(path))) unknown(path, ".msh, .vtu, .obj, .inp or .mesh");
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  check_mesh_format(path);
  writers().at(extension(path))(path, mesh);
}

}  // namespace delquad
