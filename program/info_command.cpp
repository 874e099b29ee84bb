#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/box.h"
#include "base/text.h"
#include "base/warning.h"
#include "delquad/error.h"
#include "experiments/console/progress.h"
#include "geometry/surface/model_report.h"
#include "io/cases/case_file.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/mesh_options.h"
#include "program/options.h"

namespace delquad {
namespace {

struct InfoArguments : KeyArguments {
  std::filesystem::path model, json, output;
  std::optional<std::string> size;
};

/// What a size (length) is too coarse for, as indices.
struct SmallFeatures {
  std::vector<int> curves;  ///< shorter than the size
  std::vector<int> faces;   ///< narrower, see FaceReport::width
};

using Json = nlohmann::ordered_json;

/// Degrees below which a corner is listed: no quad in it gets an eta above 1/3.
constexpr double kListedAngle = 30;

Json point_json(const Vec3& p) { return {p.x, p.y, p.z}; }

Json tags(const std::vector<Entity>& entities, const std::vector<int>& indices) {
  Json json = Json::array();
  for (const int i : indices) json.push_back(entities[i].tag);
  return json;
}

Json face_json(const ModelInfo& info, std::size_t f, const std::array<Vec3, 2>& box) {
  const FaceReport& face = info.report.faces[f];
  const Mesh& mesh = info.fine;
  return {{"tag", mesh.regions[f].tag},
          {"names", mesh.regions[f].names},
          {"area", face.area},
          {"box", {point_json(box[0]), point_json(box[1])}},
          {"topology", topology(face)},
          {"loops", face.loops},
          {"handles", face.handles},
          {"pieces", face.pieces},
          {"width", std::isfinite(face.width) ? Json(face.width) : Json()},
          {"curves", tags(mesh.curves, face.curves)}};
}

Json curve_json(const ModelInfo& info, std::size_t c) {
  const CurveReport& curve = info.report.curves[c];
  const Mesh& mesh = info.fine;
  const std::size_t n = curve.faces.size();
  return {{"tag", mesh.curves[c].tag},
          {"names", mesh.curves[c].names},
          {"length", curve.length},
          {"closed", curve.closed},
          {"kind", n < 2    ? "free"
                   : n == 2 ? "inner"
                            : "branching"},
          {"faces", tags(mesh.regions, curve.faces)}};
}

Json corner_json(const ModelInfo& info, const CornerReport& corner) {
  const Mesh& mesh = info.fine;
  return {{"face", mesh.regions[corner.face].tag},
          {"curves", {mesh.curves[corner.curves[0]].tag, mesh.curves[corner.curves[1]].tag}},
          {"at", point_json(corner.at)},
          {"angle", corner.angle}};
}

SmallFeatures smaller_than(const ModelReport& report, double size) {
  SmallFeatures small;
  for (std::size_t c = 0; c < report.curves.size(); ++c)
    if (report.curves[c].length < size) small.curves.push_back(static_cast<int>(c));
  for (std::size_t f = 0; f < report.faces.size(); ++f)
    if (report.faces[f].width < size) small.faces.push_back(static_cast<int>(f));
  return small;
}

/// The sharpest first.
std::vector<CornerReport> sharp_corners(const ModelReport& report) {
  std::vector<CornerReport> sharp;
  for (const CornerReport& corner : report.corners)
    if (corner.angle < kListedAngle) sharp.push_back(corner);
  std::ranges::stable_sort(sharp, {}, &CornerReport::angle);
  return sharp;
}

/// The bounding box of each face: its lowest and highest corner.
std::vector<std::array<Vec3, 2>> boxes_of_faces(const Mesh& mesh) {
  std::vector<std::vector<Vec3>> corners(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) corners[mesh.triangle_region[t]].push_back(mesh.points[v]);
  std::vector<std::array<Vec3, 2>> boxes;
  for (const std::vector<Vec3>& points : corners) {
    if (points.empty()) {
      boxes.push_back({});  // a face that was left out
      continue;
    }
    const Box<Vec3> box = Box<Vec3>::around(points);
    boxes.push_back({box.low, box.high});
  }
  return boxes;
}

/// The report as JSON; `size` 0: not given.
std::string info_record(const ModelInfo& info, double size) {
  const ModelReport& report = info.report;
  const Mesh& mesh = info.fine;
  Json json = {{"model", info.source},
               {"unit", mesh.unit.empty() ? Json() : Json(mesh.unit)},
               {"box", {point_json(report.low), point_json(report.high)}},
               {"diagonal", report.diagonal},
               {"area", report.area},
               {"free_length", report.free_length},
               {"vertices", report.vertices},
               {"fine_triangles", mesh.triangles.size()}};
  json["shells"] = Json::array();
  for (const ShellReport& shell : report.shells)
    json["shells"].push_back({{"faces", tags(mesh.regions, shell.faces)},
                              {"area", shell.area},
                              {"closed", shell.closed},
                              {"euler_characteristic", shell.euler_characteristic}});
  json["faces"] = Json::array();
  const auto boxes = boxes_of_faces(mesh);
  for (std::size_t f = 0; f < report.faces.size(); ++f) json["faces"].push_back(face_json(info, f, boxes[f]));
  json["curves"] = Json::array();
  for (std::size_t c = 0; c < report.curves.size(); ++c) json["curves"].push_back(curve_json(info, c));
  json["sharp_corners"] = Json::array();
  for (const CornerReport& corner : sharp_corners(report))
    json["sharp_corners"].push_back(corner_json(info, corner));
  if (size > 0) {
    const SmallFeatures small = smaller_than(report, size);
    json["size"] = size;
    json["smaller_than_size"] = {{"curves", tags(mesh.curves, small.curves)},
                                 {"faces", tags(mesh.regions, small.faces)}};
  }
  json["warnings"] = texts(info.warnings);
  // A name need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Rows of a list, and numbers in a row, that fit a terminal.
constexpr std::size_t kMostRows = 20, kMostTags = 8;

double read_size(const std::optional<std::string>& text) {
  if (!text) return 0;
  const auto size = as_number(*text);
  if (!size || !(*size > 0) || !std::isfinite(*size))
    throw InputError("--size " + (text->empty() ? "''" : *text) + ": expected a finite number > 0");
  return *size;
}

std::string list_tags(const std::vector<Entity>& entities, const std::vector<int>& indices) {
  std::string text;
  for (std::size_t k = 0; k < std::min(indices.size(), kMostTags); ++k)
    text += fmt::format("{}{}", k > 0 ? ", " : "", entities[indices[k]].tag);
  return indices.size() > kMostTags ? fmt::format("{}, ... ({})", text, indices.size()) : text;
}

/// Prints the first rows of a list by print(row).
template <class Print>
void print_rows(std::size_t n, Print print) {
  for (std::size_t i = 0; i < std::min(n, kMostRows); ++i) print(i);
  if (n > kMostRows) fmt::print("  ... and {} more (--json has all)\n", n - kMostRows);
}

template <class Wanted>
std::vector<int> curves_that(const ModelReport& report, Wanted wanted) {
  std::vector<int> curves;
  for (std::size_t c = 0; c < report.curves.size(); ++c)
    if (wanted(report.curves[c])) curves.push_back(static_cast<int>(c));
  return curves;
}

void print_overview(const ModelInfo& info) {
  const ModelReport& r = info.report;
  const Mesh& mesh = info.fine;
  fmt::print("{}\n", info.source);
  fmt::print("  lengths in   {}\n", mesh.unit.empty() ? "the file's own unit" : mesh.unit);
  fmt::print("  box          {} to {}\n  diagonal     {:.6g}\n", show_point(r.low), show_point(r.high),
             r.diagonal);
  fmt::print("  area         {:.6g}\n", r.area);
  fmt::print("  parts        {}, {}, {}, {}\n", counted(r.shells.size(), "shell"),
             counted(r.faces.size(), "face"), counted(r.curves.size(), "curve"),
             r.vertices == 1 ? "1 vertex" : fmt::format("{} vertices", r.vertices));
  const auto free = curves_that(r, [](const CurveReport& c) { return c.faces.size() < 2; });
  const auto branching = curves_that(r, [](const CurveReport& c) { return c.faces.size() > 2; });
  if (free.empty())
    fmt::print("  outline      none\n");
  else
    fmt::print("  outline      {:.6g} long, curves {}\n", r.free_length, list_tags(mesh.curves, free));
  if (!branching.empty())
    fmt::print("  branching    more than two faces at curves {}\n", list_tags(mesh.curves, branching));
}

void print_parts(const ModelInfo& info) {
  const ModelReport& r = info.report;
  const Mesh& mesh = info.fine;
  fmt::print("\nshells{:>9} {:>12} {:>8} {:>6}\n", "faces", "area", "closed", "Euler");
  print_rows(r.shells.size(), [&](std::size_t s) {
    const ShellReport& shell = r.shells[s];
    fmt::print("  {:>4} {:>8} {:>12.6g} {:>8} {:>6}\n", s + 1, shell.faces.size(), shell.area,
               shell.closed ? "yes" : "no", shell.euler_characteristic);
  });
  fmt::print("\nfaces{:>12} {:>10}  {:<20} {:<28} {}\n", "area", "width", "topology", "curves", "names");
  print_rows(r.faces.size(), [&](std::size_t f) {
    const FaceReport& face = r.faces[f];
    fmt::print("  {:>4} {:>10.4g} {:>10.4g}  {:<20} {:<28} {}\n", mesh.regions[f].tag, face.area, face.width,
               topology(face), list_tags(mesh.curves, face.curves), fmt::join(mesh.regions[f].names, ", "));
  });
  const auto boxes = boxes_of_faces(mesh);
  fmt::print("\nboxes of faces\n");
  print_rows(boxes.size(), [&](std::size_t f) {
    fmt::print("  {:>4} {} to {}\n", mesh.regions[f].tag, show_point(boxes[f][0]), show_point(boxes[f][1]));
  });
  fmt::print("\ncurves{:>11} {:>10} {:>8}  {}\n", "length", "kind", "closed", "faces");
  print_rows(r.curves.size(), [&](std::size_t c) {
    const CurveReport& curve = r.curves[c];
    const std::size_t n = curve.faces.size();
    fmt::print("  {:>4} {:>10.4g} {:>10} {:>8}  {}\n", mesh.curves[c].tag, curve.length,
               n < 2    ? "free"
               : n == 2 ? "inner"
                        : "branching",
               curve.closed ? "yes" : "no", list_tags(mesh.regions, curve.faces));
  });
}

void print_difficulties(const ModelInfo& info, double size) {
  const Mesh& mesh = info.fine;
  if (size > 0) {
    const SmallFeatures small = smaller_than(info.report, size);
    fmt::print("\nsmaller than the size {:.6g}\n", size);
    fmt::print("  curves  {}\n", small.curves.empty() ? "none" : list_tags(mesh.curves, small.curves));
    fmt::print("  faces   {}\n", small.faces.empty() ? "none" : list_tags(mesh.regions, small.faces));
  }
  const std::vector<CornerReport> sharp = sharp_corners(info.report);
  if (!sharp.empty()) fmt::print("\nsharp corners (degrees)\n");
  print_rows(sharp.size(), [&](std::size_t i) {
    const CornerReport& corner = sharp[i];
    fmt::print("  {:>6.2f}  face {}, between curves {} and {} at {}\n", corner.angle,
               mesh.regions[corner.face].tag, mesh.curves[corner.curves[0]].tag,
               mesh.curves[corner.curves[1]].tag, show_point(corner.at));
  });
  const std::vector<std::string> lines = lines_of(info.warnings);
  if (!lines.empty()) fmt::print("\nrepaired or suspicious\n");
  for (const std::string& line : lines) fmt::print("  {}\n", line);
}

int info_command(const InfoArguments& arguments) {
  const double size = read_size(arguments.size);
  Case c = read_model_case(arguments.model);
  set_keys(arguments, c);
  if (size > 0) c.size.text = *arguments.size;
  check_distinct({{"the model", arguments.model}, {"--json", arguments.json}, {"-o", arguments.output}});
  if (!arguments.json.empty()) check_output(arguments.json);
  if (!arguments.output.empty()) {
    check_mesh_format(arguments.output);
    check_output(arguments.output);
  }
  const ModelInfo info = model_info(c, size);
  if (!arguments.json.empty()) write_text_file(arguments.json, info_record(info, size));
  if (!arguments.output.empty()) write_mesh(arguments.output, info.fine);
  print_overview(info);
  print_parts(info);
  print_difficulties(info, size);
  for (const std::string& reason : info.left_out) fmt::print(stderr, "error: left out: {}\n", reason);
  return info.left_out.empty() ? kDone : kFacesLeftOut;
}

}  // namespace

void add_info(CLI::App& app, Commands& commands) {
  const auto [info, arguments] =
      add_command(app, commands, "info", "Tell what a model consists of and what is hard to mesh in it",
                  info_command, true);
  info->add_option("model", arguments.model,
                   "CAD (.step, .stp, .iges, .igs, .brep), triangles (.stl, .obj, .off, .ply, .3mf, .msh) or "
                   "a planar model (.toml, .msh)")
      ->required();
  add_size(*info, arguments.size, "wanted edge length, a number: name what is smaller");
  add_surface(*info, arguments);
  info->add_option("--json", arguments.json, "record to write, with every face, curve and sharp corner");
  info->add_option(
      "-o,--output", arguments.output,
      "the model as it is understood, to look at (.vtu, .msh): triangles by face, lines by curve, as "
      "they are found in a triangulation");
}

}  // namespace delquad
