#include <algorithm>

#include "experiments/sweep/peer_sizes.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

void write_view(TextWriter& out, const SampledSize& size) {
  const Mesh& mesh = size.mesh;
  out << "View \"delta\" {\n";
  for (const auto& v : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.points[v[k]];
      out << (k == 0 ? "ST(" : ", ") << p.x << ", " << p.y << ", " << p.z;
    }
    out << "){" << size.delta[v[0]] << ", " << size.delta[v[1]] << ", " << size.delta[v[2]] << "};\n";
  }
  out << "};\n";
}

void write_solution(TextWriter& out, const SampledSize& size) {
  out << "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n" << size.delta.size() << "\n1 1\n";
  for (const double delta : size.delta) out << delta << "\n";
  out << "End\n";
}

void write_points(TextWriter& out, const SampledSize& size) {
  for (std::size_t i = 0; i < size.delta.size(); ++i) {
    const Vec3& p = size.mesh.points[i];
    out << p.x << " " << p.y << " " << p.z << " " << size.delta[i] << "\n";
  }
}

}  // namespace

Mesh triangles_of_domain(const Prepared& prepared) {
  Meshing meshing(prepared);
  for (const Stage* stage : parse_word("F").stages) meshing.run(*stage);
  return meshing.mesh();
}

SampledSize sample_sizes(const PeerTask& task) {
  SampledSize size{triangles_of_domain(task.prepared), {}};
  int hint = -1;
  for (const Vec3& p : size.mesh.points)
    size.delta.push_back(task.field_scale * task.prepared->size.field->at(p, hint));
  return size;
}

const std::vector<std::string>& size_field_formats() {
  static const std::vector<std::string> formats = {"pos", "sol", "points"};
  return formats;
}

fs::path write_size_field(const SampledSize& size, const std::string& format, const fs::path& folder) {
  const fs::path file = folder / ("size." + format);
  write_file_atomically(file, [&](std::ostream& stream) {
    TextWriter out(stream);
    (format == "pos" ? write_view : format == "sol" ? write_solution : write_points)(out, size);
    out.flush();
  });
  if (format == "sol") write_mesh(folder / "size.mesh", size.mesh);
  return file;
}

}  // namespace delquad
