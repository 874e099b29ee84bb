// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/hexahedra.h"
#include "geometry/mesh/check_mesh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "program/commands.h"
#include "program/mesh_options.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

constexpr const char* kTextPoints = ".txt";

std::vector<Vec3> read_text_points(const std::filesystem::path& path) {
  TextScanner in(path);
  std::vector<Vec3> points;
  while (!in.at_end()) {
    if (in.next_is('#')) {
      in.rest_of_line();
      continue;
    }
    Vec3 p;
    for (double* x : {&p.x, &p.y, &p.z}) *x = in.real("a coordinate");
    if (!in.at_end_of_line() && !in.next_is('#'))
      in.fail("more than three coordinates on a line: expected x, y and z");
    points.push_back(p);
  }
  return points;
}

/// Lines as one chain; `where` names them.
std::vector<Vec3> chain_of(const Mesh& mesh, const std::vector<std::array<int, 2>>& lines,
                           const Vec3& start_near, const std::string& where) {
  std::vector<std::vector<int>> neighbours(mesh.points.size());
  for (const auto& [a, b] : lines) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<int> ends;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i].size() == 1) ends.push_back(static_cast<int>(i));
    if (neighbours[i].size() > 2) {
      const Vec3& p = mesh.points[i];
      refuse("{}: {} lines meet at ({}, {}, {}): expected one chain", where, neighbours[i].size(), p.x, p.y,
             p.z);
    }
  }
  if (ends.size() != 2)
    refuse("{}: its {} lines have {} ends: expected one open chain, with two", where, lines.size(),
           ends.size());
  const auto far = [&](int i) { return norm(mesh.points[i] - start_near); };
  int before = -1, at = far(ends[1]) < far(ends[0]) ? ends[1] : ends[0];
  std::vector<Vec3> points = {mesh.points[at]};
  for (;;) {
    const auto next = std::ranges::find_if(neighbours[at], [&](int i) { return i != before; });
    if (next == neighbours[at].end()) break;
    before = at;
    at = *next;
    points.push_back(mesh.points[at]);
  }
  if (points.size() != lines.size() + 1)
    refuse("{}: expected one chain of lines, found one of {} lines and {} lines of closed curves", where,
           points.size() - 1, lines.size() + 1 - points.size());
  return points;
}

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return std::ranges::any_of(mesh_formats(), [&](const MeshFormat& format) {
    return format.read != nullptr && std::ranges::find(format.extensions, kind) != format.extensions.end();
  });
}

/// Points of a line. "points.txt" has x, y and z of one on each line, and comments behind '#'. For a mesh
/// file it is the chain of its lines, or of the lines on the curves of a name ("mesh.msh:NAME"). The chain
/// begins at the end that is nearer to a point. Throws InputError with file and line, and for lines that make
/// no single open chain.
std::vector<Vec3> read_polyline(const std::string& text, const Vec3& start_near) {
  if (kind_of_file(text) == kTextPoints) return read_text_points(text);
  std::string file = text, name;
  for (std::size_t at = text.find(':'); at != std::string::npos && !is_mesh_file(file);
       at = text.find(':', at + 1))
    if (is_mesh_file(text.substr(0, at))) file = text.substr(0, at), name = text.substr(at + 1);
  if (!is_mesh_file(file))
    refuse("'{}': expected a file of points (.txt), a mesh with lines, or MESH:NAME for the curve NAME",
           text);
  const Mesh mesh = read_mesh(file);
  require_straight(mesh, file);
  std::vector<std::array<int, 2>> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const std::vector<std::string>& names = mesh.curves[mesh.line_curve[l]].names;
    if (name.empty() || std::ranges::find(names, name) != names.end()) lines.push_back(mesh.lines[l]);
  }
  if (lines.empty())
    throw InputError(file + (name.empty() ? ": has no lines" : ": no curve has the name '" + name + "'"));
  return chain_of(mesh, lines, start_near, text);
}

struct ExtrudeArguments {
  std::filesystem::path mesh, output, json;
  std::string along, around, curve;  ///< as they were typed; empty: another way
  bool normals = false, both_sides = false;
  std::optional<double> angle, thickness;
  std::vector<std::string> heights;  ///< "NAME=LENGTH"
  int layers = 0;                    ///< 0: of a curve as many as it has segments
  double growth = 1;
  long long max_elements = 50'000'000;
  int threads = thread_count();
  MshOptions file;
};

void require_with(bool given, const char* option, bool allowed, const char* with) {
  if (given && !allowed) refuse("{} goes with {} only", option, with);
}

SweepPath path_of(const ExtrudeArguments& arguments, const Mesh& mesh) {
  const int ways =
      !arguments.along.empty() + !arguments.around.empty() + !arguments.curve.empty() + arguments.normals;
  if (ways != 1) throw InputError("expected one of --along, --around, --curve and --normals");
  require_with(arguments.angle.has_value(), "--angle", !arguments.around.empty(), "--around");
  require_with(arguments.both_sides, "--both-sides", arguments.normals, "--normals");
  require_with(arguments.thickness.has_value(), "--thickness", arguments.normals || !arguments.along.empty(),
               "--along and --normals");
  if (arguments.layers == 0 && arguments.curve.empty())
    throw InputError("--layers is missing: expected a number of layers");
  if (!arguments.along.empty()) {
    const auto v = read_list("--along", arguments.along, 3, "0,0,2.5");
    Vec3 shift{v[0], v[1], v[2]};
    if (arguments.thickness && norm(shift) > 0) shift = (*arguments.thickness / norm(shift)) * shift;
    return AlongVector{shift};
  }
  if (!arguments.around.empty()) {
    const auto v =
        read_list("--around", arguments.around, 6, "0,0,0,0,1,0: a point of the axis and its direction");
    return AroundAxis{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, arguments.angle.value_or(AroundAxis{}.degrees)};
  }
  if (arguments.normals) {
    if (!arguments.thickness) throw InputError("--normals needs --thickness");
    return AlongNormals{*arguments.thickness, arguments.both_sides};
  }
  Vec3 centre;
  for (const Vec3& p : mesh.points) centre = centre + (1.0 / static_cast<double>(mesh.points.size())) * p;
  return located("--curve " + arguments.curve,
                 [&] { return AlongCurve{read_polyline(arguments.curve, centre)}; });
}

SweepLayers layers_of(const ExtrudeArguments& arguments) {
  SweepLayers layers{arguments.layers, arguments.growth, arguments.max_elements};
  for (const std::string& text : arguments.heights) {
    const std::size_t at = text.rfind('=');
    const auto height = at == std::string::npos ? std::nullopt : as_number(text.substr(at + 1));
    if (!height) refuse("--height '{}': expected NAME=LENGTH, such as boss=12.5", text);
    if (!layers.heights.emplace(text.substr(0, at), *height).second)
      refuse("--height '{}': this region has a height already: expected one for each", text);
  }
  return layers;
}

int extrude_command(const ExtrudeArguments& arguments) {
  check_cell_format(arguments.output, arguments.file);
  // The curve may lie in the mesh's own file.
  for (const auto& [what, path] : {std::pair<std::string, std::filesystem::path>("the mesh", arguments.mesh),
                                   std::pair<std::string, std::filesystem::path>("--curve", arguments.curve)})
    check_distinct({{what, path}, {"-o", arguments.output}, {"--json", arguments.json}});
  check_output(arguments.output);
  if (!arguments.json.empty()) check_output(arguments.json);
  const RunScope scope({.threads = arguments.threads});
  ReadNotes notes;
  const Mesh mesh = read_mesh(arguments.mesh, &notes);
  const SweepPath path = path_of(arguments, mesh);
  const Mesh hexahedra =
      located(arguments.mesh.string(), [&] { return extrude(mesh, path, layers_of(arguments), &notes); });
  if (const auto renamed = renamed_in_file(arguments.output, hexahedra); !renamed.empty())
    notes.push_back(fmt::format("{} cannot hold all names as they are: {}", arguments.output.string(),
                                fmt::join(renamed, "; ")));
  if (const auto others = ignored_keywords(arguments.mesh); !others.empty())
    notes.push_back(fmt::format("{} loses these keywords of {}: {}", arguments.output.string(),
                                arguments.mesh.string(), others));
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  const CellMeasures measures = measure(hexahedra);
  write_mesh(arguments.output, hexahedra, arguments.file);
  if (!arguments.json.empty())
    write_text_file(arguments.json, cells_record(arguments.mesh.string(), hexahedra, measures));
  fmt::print("{}\n", arguments.output.string());
  print_cells(hexahedra, measures);
  return kDone;
}

}  // namespace

void add_extrude(CLI::App& app, Commands& commands) {
  const auto [extrude, arguments] =
      add_command(app, commands, "extrude", "Sweep a mesh of quads: hexahedra", extrude_command, true);
  extrude->add_option("mesh", arguments.mesh, "mesh file, quads alone")->required();
  extrude
      ->add_option("-o,--output", arguments.output,
                   "hexahedra to write (.msh, .vtu, .inp, .e, .cgns, .med, .su2, .foam, .bdf or .unv)")
      ->required();
  extrude->add_option("--along", arguments.along,
                      "X,Y,Z: the vector from the first layer of nodes to the last");
  extrude->add_option("--around", arguments.around,
                      "PX,PY,PZ,DX,DY,DZ: a point of the axis and its direction");
  extrude->add_option("--angle", arguments.angle,
                      "degrees around the axis; default: 360, which closes the ring");
  extrude->add_option("--curve", arguments.curve,
                      "points of a line (.txt, x y z on each), or FILE[:NAME], lines of a mesh file");
  extrude->add_flag("--normals", arguments.normals, "along the normals: shells get a thickness");
  extrude->add_option("--thickness", arguments.thickness,
                      "with --normals, negative against them; with --along the length in the vector's place");
  extrude->add_flag("--both-sides", arguments.both_sides, "half of the thickness to each side");
  extrude
      ->add_option("--layers", arguments.layers, "of hexahedra; default with --curve: one for each segment")
      ->check(kLength);
  extrude
      ->add_option("--growth", arguments.growth, "height of each layer over the height of the layer before")
      ->capture_default_str()
      ->check(kLength);
  extrude->add_option("--height", arguments.heights,
                      "NAME=LENGTH: where a region ends, with --along or --normals; repeatable");
  add_msh_file(*extrude, arguments.file);
  extrude->add_option("--element", arguments.file.element,
                      "of .inp: C3D8, C3D8I, C3D8R, C3D20, C3D20R, DC3D8 or DC3D20");
  extrude->add_option("--json", arguments.json, "record to write");
  add_max_elements(*extrude, arguments.max_elements, "refuse to make more hexahedra than this");
  add_threads(*extrude, arguments.threads);
}

}  // namespace delquad
