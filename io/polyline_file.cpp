#include "io/polyline_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "delquad/error.h"
#include "geometry/mesh/check_mesh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

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
    if (!in.at_end_of_line() && !in.next_is('#')) in.fail("more than three coordinates on a line");
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
      throw InputError(fmt::format("{}: {} lines meet at ({}, {}, {}): expected one chain", where,
                                   neighbours[i].size(), p.x, p.y, p.z));
    }
  }
  if (ends.size() != 2)
    throw InputError(fmt::format("{}: its {} lines have {} ends: expected one open chain, with two", where,
                                 lines.size(), ends.size()));
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
    throw InputError(fmt::format("{}: beside one chain of {} lines there are {} that close", where,
                                 points.size() - 1, lines.size() + 1 - points.size()));
  return points;
}

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return std::ranges::any_of(mesh_formats(), [&](const MeshFormat& format) {
    return format.read != nullptr && std::ranges::find(format.extensions, kind) != format.extensions.end();
  });
}

}  // namespace

std::vector<Vec3> read_polyline(const std::string& text, const Vec3& start_near) {
  if (kind_of_file(text) == kTextPoints) return read_text_points(text);
  std::string file = text, name;
  for (std::size_t at = text.find(':'); at != std::string::npos && !is_mesh_file(file);
       at = text.find(':', at + 1))
    if (is_mesh_file(text.substr(0, at))) file = text.substr(0, at), name = text.substr(at + 1);
  if (!is_mesh_file(file))
    throw InputError(
        fmt::format("'{}': expected a file of points (.txt) or of a mesh with lines, perhaps with :NAME of a "
                    "curve behind it",
                    text));
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

}  // namespace delquad
