#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "base/text.h"
#include "delquad/error.h"
#include "experiments/console/progress.h"
#include "geometry/surface/model_report.h"
#include "io/cases/case_file.h"
#include "io/mesh_io.h"
#include "program/check_files.h"
#include "program/commands.h"
#include "program/info_record.h"

namespace delquad {
namespace {

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

}  // namespace

int info_command(const InfoArguments& arguments) {
  const double size = read_size(arguments.size);
  Case c = read_model_case(arguments.model);
  set_surface(arguments, c);
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

}  // namespace delquad
