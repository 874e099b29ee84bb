// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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

/// Tags of those whose length or width is less than the size.
Json smaller_than(double size, const Json& parts, const char* measure) {
  Json small = Json::array();
  for (const Json& part : parts)
    if (!part[measure].is_null() && part[measure] < size) small.push_back(part["tag"]);
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

/// The report; `size` 0: not given.
Json info_json(const ModelInfo& info, double size) {
  const ModelReport& report = info.report;
  const Mesh& mesh = info.fine;
  Json json = {{"model", info.source},
               {"unit", mesh.unit.empty() ? Json() : Json(mesh.unit)},
               {"box", {point_json(report.low), point_json(report.high)}},
               {"diagonal", report.diagonal},
               {"area", report.area},
               {"free_length", report.free_length},
               {"vertices", report.vertices},
               {"fine_triangles", mesh.triangles.size()},
               {"shells", Json::array()},
               {"faces", Json::array()},
               {"curves", Json::array()},
               {"sharp_corners", Json::array()}};
  for (const ShellReport& shell : report.shells)
    json["shells"].push_back({{"faces", tags(mesh.regions, shell.faces)},
                              {"area", shell.area},
                              {"closed", shell.closed},
                              {"euler_characteristic", shell.euler_characteristic}});
  const auto boxes = boxes_of_faces(mesh);
  for (std::size_t f = 0; f < report.faces.size(); ++f) json["faces"].push_back(face_json(info, f, boxes[f]));
  for (std::size_t c = 0; c < report.curves.size(); ++c) json["curves"].push_back(curve_json(info, c));
  for (const CornerReport& corner : sharp_corners(report))
    json["sharp_corners"].push_back(corner_json(info, corner));
  if (size > 0) {
    json["size"] = size;
    json["smaller_than_size"] = {{"curves", smaller_than(size, json["curves"], "length")},
                                 {"faces", smaller_than(size, json["faces"], "width")}};
  }
  json["warnings"] = texts(info.warnings);
  return json;
}

/// Rows of a list, without -v, and numbers in a row.
constexpr std::size_t kMostRows = 20, kMostTags = 8;

double read_size(const std::optional<std::string>& text) {
  if (!text) return 0;
  const auto size = as_number(*text);
  if (!size || !(*size > 0) || !std::isfinite(*size))
    throw InputError("--size " + (text->empty() ? "''" : *text) +
                     ": expected a finite number > 0 [bad-size]");
  return *size;
}

double number(const Json& value) { return value.is_null() ? HUGE_VAL : value.get<double>(); }

std::string show(const Json& point) { return show_point(Vec3{point[0], point[1], point[2]}); }

const char* yes_or_no(const Json& flag) { return flag.get<bool>() ? "yes" : "no"; }

std::string list(const Json& tags) {
  std::string text;
  for (std::size_t k = 0; k < std::min(tags.size(), kMostTags); ++k)
    text += fmt::format("{}{}", k > 0 ? ", " : "", tags[k].get<int>());
  return tags.size() > kMostTags ? fmt::format("{}, ... ({})", text, tags.size()) : text;
}

std::string names_of(const Json& part) {
  return fmt::format("{}", fmt::join(part["names"].get<std::vector<std::string>>(), ", "));
}

/// Prints the first rows of a list by print(row, its number from 1).
template <class Print>
void print_rows(const Json& rows, Print print) {
  const std::size_t n = verbosity() == Verbosity::kAll ? rows.size() : std::min(rows.size(), kMostRows);
  for (std::size_t i = 0; i < n; ++i) print(rows[i], i + 1);
  if (rows.size() > n) fmt::print("  ... and {} more (-v has all)\n", rows.size() - n);
}

void print_overview(const Json& json) {
  fmt::print("{}\n", json["model"].get<std::string>());
  fmt::print("  lengths in   {}\n",
             json["unit"].is_null() ? "the file's own unit" : json["unit"].get<std::string>());
  fmt::print("  box          {} to {}\n  diagonal     {:.6g}\n", show(json["box"][0]), show(json["box"][1]),
             number(json["diagonal"]));
  fmt::print("  area         {:.6g}\n", number(json["area"]));
  const int vertices = json["vertices"];
  fmt::print("  parts        {}, {}, {}, {}\n", counted(json["shells"].size(), "shell"),
             counted(json["faces"].size(), "face"), counted(json["curves"].size(), "curve"),
             vertices == 1 ? "1 vertex" : fmt::format("{} vertices", vertices));
  std::map<std::string, Json> curves;  // by kind
  for (const Json& curve : json["curves"]) curves[curve["kind"]].push_back(curve["tag"]);
  if (!curves.contains("free"))
    fmt::print("  outline      none\n");
  else
    fmt::print("  outline      {:.6g} long, curves {}\n", number(json["free_length"]), list(curves["free"]));
  if (curves.contains("branching"))
    fmt::print("  branching    more than two faces at curves {}\n", list(curves["branching"]));
}

void print_parts(const Json& json) {
  fmt::print("\nshells{:>9} {:>12} {:>8} {:>6}\n", "faces", "area", "closed", "Euler");
  print_rows(json["shells"], [&](const Json& shell, std::size_t i) {
    fmt::print("  {:>4} {:>8} {:>12.6g} {:>8} {:>6}\n", i, shell["faces"].size(), number(shell["area"]),
               yes_or_no(shell["closed"]), shell["euler_characteristic"].get<int>());
  });
  fmt::print("\nfaces{:>12} {:>10}  {:<20} {:<28} {}\n", "area", "width", "topology", "curves", "names");
  print_rows(json["faces"], [&](const Json& face, std::size_t) {
    fmt::print("  {:>4} {:>10.4g} {:>10.4g}  {:<20} {:<28} {}\n", face["tag"].get<int>(),
               number(face["area"]), number(face["width"]), face["topology"].get<std::string>(),
               list(face["curves"]), names_of(face));
  });
  fmt::print("\nboxes of faces\n");
  print_rows(json["faces"], [&](const Json& face, std::size_t) {
    fmt::print("  {:>4} {} to {}\n", face["tag"].get<int>(), show(face["box"][0]), show(face["box"][1]));
  });
  fmt::print("\ncurves{:>11} {:>10} {:>8}  {:<10} {}\n", "length", "kind", "closed", "faces", "names");
  print_rows(json["curves"], [&](const Json& curve, std::size_t) {
    fmt::print("  {:>4} {:>10.4g} {:>10} {:>8}  {:<10} {}\n", curve["tag"].get<int>(),
               number(curve["length"]), curve["kind"].get<std::string>(), yes_or_no(curve["closed"]),
               list(curve["faces"]), names_of(curve));
  });
}

void print_difficulties(const Json& json, const std::vector<Warning>& warnings) {
  if (json.contains("size")) {
    fmt::print("\nsmaller than the size {:.6g}\n", number(json["size"]));
    for (const auto& [what, tags] : json["smaller_than_size"].items())
      fmt::print("  {:<7} {}\n", what, tags.empty() ? "none" : list(tags));
  }
  if (!json["sharp_corners"].empty()) fmt::print("\nsharp corners (degrees)\n");
  print_rows(json["sharp_corners"], [&](const Json& corner, std::size_t) {
    fmt::print("  {:>6.2f}  face {}, between curves {} and {} at {}\n", number(corner["angle"]),
               corner["face"].get<int>(), corner["curves"][0].get<int>(), corner["curves"][1].get<int>(),
               show(corner["at"]));
  });
  const std::vector<std::string> lines = lines_of(warnings);
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
  const Json json = info_json(info, size);
  // A name need not be UTF-8; JSON must be.
  if (!arguments.json.empty())
    write_text_file(arguments.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  if (!arguments.output.empty()) write_mesh(arguments.output, info.fine);
  print_overview(json);
  print_parts(json);
  print_difficulties(json, info.warnings);
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
