// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <numbers>

#include "base/located.h"
#include "base/text.h"
#include "delquad/domain.h"
#include "experiments/sweep/domain_brep.h"
#include "experiments/sweep/peer.h"
#include "geometry/cad/example_models.h"
#include "geometry/mesh/check_mesh.h"
#include "io/cases/problem_record.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr const char *kDomain = "domain.brep", *kSizeView = "size.pos";

/// The curves of a domain; where it has lines alone, each of them is to be one element.
void write_domain(TextWriter& out, const Prepared& prepared, const fs::path& folder) {
  write_domain_brep(folder / kDomain, prepared);
  out << "Merge \"" << kDomain << "\";\n";
  if (domain_curves(prepared).empty()) out << "Transfinite Curve {:} = 2;\n";
}

/// The file of a surface, unpacked, or the example as a STEP file.
fs::path surface_file(const PeerTask& task, const fs::path& folder) {
  SurfaceSpec plain;  // with what leaves the faces as they are
  plain.feature_angle = task.c.surface.feature_angle;
  plain.names = task.c.surface.names;
  plain.keep = task.c.surface.keep;
  plain.simplify = task.c.surface.simplify;
  if (!are_same(task.c.surface, plain))
    throw NotApplicable("'" + task.peer.name +
                        "' gets the model's file as it is, but the case changes its faces");
  const std::string example = example_of(task.c);
  if (example.empty()) {
    const fs::path given = fs::absolute(model_path(task.c));
    if (given.extension() != ".gz") return given;
    write_text_file(folder / ("model" + kind_of_file(given)), read_whole_file(given));
    return folder / ("model" + kind_of_file(given));
  }
  const fs::path file = folder / "model.step";
  write_file_atomically(file, [&](std::ostream& out) { write_example(example, CadFormat::kStep, out); });
  return file;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char ch : text) result += (ch == '"' || ch == '\\' ? "\\" : "") + std::string(1, ch);
  return result + '"';
}

bool is_triangulation(const fs::path& file) {
  const std::string kind = kind_of_file(file);
  return !is_surface_file(file) || kind == ".stl" || kind == ".obj" || kind == ".off";
}

/// Every Gmsh reads MSH and STL; only some read OBJ and OFF.
fs::path read_by_gmsh(const fs::path& file, const fs::path& folder) {
  if (!is_triangulation(file) || file.extension() == ".stl" || file.extension() == ".msh") return file;
  const Mesh read = read_mesh(file);
  require_straight(read, file.string());
  Mesh mesh;
  mesh.points = read.points;
  mesh.triangles = read.triangles;
  for (const auto& [a, b, c, d] : read.quads)
    for (const std::array<int, 3>& half : {std::array{a, b, c}, std::array{a, c, d}})
      mesh.triangles.push_back(half);
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  mesh.regions = {{1, {}}};
  write_mesh(folder / "model.msh", mesh);
  return folder / "model.msh";
}

void write_surface(TextWriter& out, const Case& c, const fs::path& file) {
  out << "Merge " << quoted(file.string()) << ";\n";
  if (is_triangulation(file)) {
    constexpr double kFeatureAngle = 40;  // degrees, as for our own
    out << "ClassifySurfaces{" << c.surface.feature_angle.value_or(kFeatureAngle) * std::numbers::pi / 180
        << ", 1, 1, Pi};\nCreateGeometry;\n";
  }
}

void write_script(const PeerTask& task, const fs::path& script) {
  const Prepared& prepared = task.prepared;
  const auto size = uniform_size(task.c);
  const fs::path folder = script.parent_path();
  const fs::path model =
      prepared.is_surface() ? read_by_gmsh(surface_file(task, folder), folder) : fs::path();
  if (!size) write_size_field(sample_sizes(task), "pos", folder);
  write_text_file(script, [&](TextWriter& out) {
    prepared.is_surface() ? write_surface(out, task.c, model) : write_domain(out, prepared, folder);
    if (size)
      out << "Mesh.MeshSizeMin = " << task.scale * *size << ";\nMesh.MeshSizeMax = " << task.scale * *size
          << ";\n";
    else
      out << "Merge \"" << kSizeView
          << "\";\nField[1] = PostView;\nField[1].ViewIndex = 0;\nBackground Field = 1;\n"
          << "Mesh.MeshSizeFromPoints = 0;\n";
    out << "Mesh.MeshSizeExtendFromBoundary = 0;\n";
  });
}

/// The numbers of a point.
void write_values(TextWriter& out, const SampledSize& size, std::size_t point) {
  if (!size.delta.empty()) {
    out << size.delta[point];
    return;
  }
  const Tensor2& m = size.metric[point];
  out << m.xx << " " << m.xy << " " << m.yy;
}

void write_view(TextWriter& out, const SampledSize& size) {
  const Mesh& mesh = size.mesh;
  const bool is_metric = size.delta.empty();
  out << "View \"delta\" {\n";
  for (const auto& v : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.points[v[k]];
      out << (k > 0 ? ", " : is_metric ? "TT(" : "ST(") << p.x << ", " << p.y << ", " << p.z;
    }
    for (int k = 0; k < 3; ++k) {
      out << (k == 0 ? "){" : ", ");
      if (!is_metric) {
        out << size.delta[v[k]];
        continue;
      }
      const Tensor2& m = size.metric[v[k]];
      out << m.xx << ", " << m.xy << ", 0, " << m.xy << ", " << m.yy << ", 0, 0, 0, 1";
    }
    out << "};\n";
  }
  out << "};\n";
}

void write_solution(TextWriter& out, const SampledSize& size) {
  const bool is_metric = size.delta.empty();
  out << "MeshVersionFormatted 2\nDimension " << (is_metric ? 2 : 3) << "\nSolAtVertices\n"
      << size.mesh.points.size() << (is_metric ? "\n1 3\n" : "\n1 1\n");
  for (std::size_t i = 0; i < size.mesh.points.size(); ++i) {
    write_values(out, size, i);
    out << "\n";
  }
  out << "End\n";
}

void write_points(TextWriter& out, const SampledSize& size) {
  for (std::size_t i = 0; i < size.mesh.points.size(); ++i) {
    const Vec3& p = size.mesh.points[i];
    out << p.x << " " << p.y << " " << p.z << " ";
    write_values(out, size, i);
    out << "\n";
  }
}

/// Returns the triangles of F, of the wanted size, in the plane or on the surface. If there is a metric,
/// returns the triangles on which it is known, because others might be inverted.
Mesh triangles_of_domain(const Prepared& prepared) {
  if (std::optional<NodalMetric> metric = followed_metric(prepared)) return std::move(metric->mesh);
  Meshing meshing(prepared);
  for (const Stage* stage : parse_pipeline("F").stages) meshing.run(*stage);
  return meshing.mesh();
}

}  // namespace

std::optional<double> uniform_size(const Case& c) {
  const SizeSpec& s = c.size;
  auto size = as_number(s.text);
  if (s.text.empty() && s.max > 0) size = s.max;
  if (!size || c.quads || !s.sources.empty() || !s.named.empty() || s.curvature > 0) return std::nullopt;
  return (s.max > 0 ? std::min(*size, s.max) : *size) / c.refine;
}

fs::path write_peer_input(const PeerTask& task, const fs::path& folder) {
  const Peer& peer = task.peer;
  const bool on_surface = task.prepared.is_surface();
  const HandOver given = on_surface ? peer.surfaces : peer.planar;
  if (given == HandOver::kNothing)
    refuse<NotApplicable>("'{}' meshes no {}", peer.name, on_surface ? "surfaces" : "planar domains");
  if (on_surface && given == HandOver::kModel && peer.input != kGmshScript) return surface_file(task, folder);
  if (!task.c.layers.empty())
    throw NotApplicable("layers along curves are made by this program's meshes alone");
  const fs::path file = folder / ("input." + peer.input);
  if (peer.input == kGmshScript)
    write_script(task, file);
  else
    write_mesh(file, given == HandOver::kTriangles ? triangles_of_domain(task.prepared)
                                                   : boundary_of(task.prepared));
  return file;
}

Mesh boundary_of(const Prepared& prepared) {
  return followed_metric(prepared) ? Meshing(prepared).mesh() : prepared->boundary;
}

SampledSize sample_sizes(const PeerTask& task) {
  if (std::optional<NodalMetric> metric = followed_metric(task.prepared)) {
    const double factor = 1 / (task.field_scale * task.field_scale);
    for (Tensor2& m : metric->at) m = {factor * m.xx, factor * m.xy, factor * m.yy};
    return {std::move(metric->mesh), {}, std::move(metric->at)};
  }
  SampledSize size{triangles_of_domain(task.prepared), {}, {}};
  int hint = -1;
  for (const Vec3& p : size.mesh.points)
    size.delta.push_back(task.field_scale * task.prepared->size.field->at(p, hint));
  return size;
}

fs::path write_size_field(const SampledSize& size, const std::string& format, const fs::path& folder) {
  const fs::path file = folder / ("size." + format);
  write_text_file(file, [&](TextWriter& out) {
    (format == "pos" ? write_view : format == "sol" ? write_solution : write_points)(out, size);
  });
  if (format == "sol") write_mesh(folder / "size.mesh", size.mesh);
  return file;
}

}  // namespace delquad
