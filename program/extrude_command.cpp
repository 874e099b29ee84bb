#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

#include "base/box.h"
#include "base/context.h"
#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/hexahedra.h"
#include "io/mesh_io.h"
#include "io/polyline_file.h"
#include "program/check_files.h"
#include "program/commands.h"

namespace delquad {

namespace {

/// Numbers separated by commas.
std::vector<double> read_list(const std::string& option, const std::string& text, std::size_t count,
                              const char* example) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto value = as_number(part);
    numbers.push_back(value && std::isfinite(*value) ? *value : std::nan(""));
  }
  if (numbers.size() != count ||
      std::any_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); }))
    throw InputError(
        fmt::format("{} '{}': expected {} finite numbers, such as {}", option, text, count, example));
  return numbers;
}

void require_with(bool given, const char* option, bool allowed, const char* with) {
  if (given && !allowed) throw InputError(fmt::format("{} goes with {} only", option, with));
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
    throw InputError("--layers is missing: how many there are to be");
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

using Json = nlohmann::ordered_json;

Json entities_json(const std::vector<Entity>& entities, const std::vector<int>& entity_of,
                   const char* items) {
  std::vector<long long> counts(entities.size(), 0);
  for (const int e : entity_of) ++counts[e];
  Json all = Json::array();
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (counts[i] > 0)
      all.push_back({{"number", entities[i].tag}, {"names", entities[i].names}, {items, counts[i]}});
  return all;
}

std::string extrusion_record(const ExtrudeArguments& arguments, const HexMesh& mesh,
                             const HexMeasures& measures) {
  const Json json = {{"mesh", arguments.mesh.string()},
                     {"points", mesh.points.size()},
                     {"hexahedra", mesh.hexahedra.size()},
                     {"least_scaled_jacobian", measures.least_jacobian},
                     {"mean_scaled_jacobian", measures.mean_jacobian},
                     {"volume", measures.volume},
                     {"unit", mesh.unit.empty() ? Json() : Json(mesh.unit)},
                     {"volumes", entities_json(mesh.volumes, mesh.hex_volume, "hexahedra")},
                     {"faces", entities_json(mesh.faces, mesh.quad_face, "quads")},
                     {"curves", entities_json(mesh.curves, mesh.line_curve, "lines")}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

int extrude_command(const ExtrudeArguments& arguments) {
  check_hex_format(arguments.output, arguments.binary);
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
  const HexMesh hexahedra = located(arguments.mesh.string(), [&] {
    return extrude(mesh, path, {arguments.layers, arguments.growth, arguments.max_elements}, &notes);
  });
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  const HexMeasures measures = measure(hexahedra);
  write_hexahedra(arguments.output, hexahedra, arguments.binary);
  if (!arguments.json.empty())
    write_text_file(arguments.json, extrusion_record(arguments, hexahedra, measures));
  fmt::print("{}\n", arguments.output.string());
  fmt::print("  {:<10} {:>12}\n  {:<10} {:>12}\n", "hexahedra", hexahedra.hexahedra.size(), "points",
             hexahedra.points.size());
  fmt::print("  {:<10} {:>12.6g} least\n  {:<10} {:>12.6g} mean\n", "scaled J", measures.least_jacobian,
             "scaled J", measures.mean_jacobian);
  fmt::print("  {:<10} {:>12.9g}{}\n", "volume", measures.volume,
             hexahedra.unit.empty() ? "" : " " + hexahedra.unit + "^3");
  return kDone;
}

}  // namespace delquad
