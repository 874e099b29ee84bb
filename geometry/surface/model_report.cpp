// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/model_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/box.h"
#include "base/box_tree.h"
#include "base/disjoint_sets.h"
#include "base/segment.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
/// Angle, in degrees, below which two curves that meet bound a corner and not a strip.
constexpr double kCornerAngle = 60;
/// Largest cosine between the inward directions of two sides that face each other. Least cosine between
/// either direction and the line across.
constexpr double kOpposite = -0.7, kAcross = 0.9;

std::array<int, 2> sorted_ends(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// A side of a chart's boundary.
struct BoundarySide {
  Vec3 from, to, inwards;  ///< unit direction into the chart
  int curve;
};

/// Returns the least distance between sides that face each other, except sides of pairs of curves in
/// `corners`.
double least_gap(const std::vector<BoundarySide>& sides, const std::vector<std::array<int, 2>>& corners) {
  std::vector<Box<Vec3>> boxes;
  for (const BoundarySide& s : sides) boxes.push_back(Box<Vec3>::around({s.from, s.to}));
  const BoxTree<Vec3> tree(boxes);
  double least2 = kInf;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const BoundarySide& side = sides[i];
    const Vec3 x = 0.5 * (side.from + side.to);
    tree.nearest(x, least2, [&](int j) {
      const BoundarySide& other = sides[j];
      if (other.from == side.to && other.to == side.from) return;  // an embedded curve
      if (dot(side.inwards, other.inwards) > kOpposite) return;
      const Vec3 way = nearest_on_segment(x, other.from, other.to) - x;
      const double gap2 = dot(way, way), gap = std::sqrt(gap2);
      if (gap2 >= least2 || dot(way, side.inwards) < kAcross * gap ||
          dot(way, other.inwards) > -kAcross * gap)
        return;
      if (std::ranges::binary_search(corners, sorted_ends(side.curve, other.curve))) return;
      least2 = gap2;
    });
  }
  return std::sqrt(least2);
}

class Reporter {
 public:
  explicit Reporter(const SurfaceModel& model)
      : model_(model), mesh_(model.fine), sides_(sorted_half_edges(mesh_)) {
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      line_curve_[sorted_ends(mesh_.lines[l][0], mesh_.lines[l][1])] = mesh_.line_curve[l];
  }

  ModelReport run() {
    measure_box();
    measure_curves();
    measure_faces();
    find_shells();
    return std::move(report_);
  }

 private:
  void measure_box() {
    const auto box = Box<Vec3>::around(std::span(mesh_.points));
    report_.low = box.low, report_.high = box.high;
    report_.diagonal = norm(box.size());
    report_.vertices = static_cast<int>(model_.corners.size());
  }

  void measure_curves() {
    report_.curves.resize(mesh_.curves.size());
    const std::vector<double> lengths = lengths_of_curves(mesh_);
    const std::vector<std::vector<int>> points = points_of_curves(mesh_);
    for (std::size_t c = 0; c < points.size(); ++c) {
      report_.curves[c].length = lengths[c];
      report_.curves[c].closed = points[c].empty() || points[c].front() == points[c].back();
    }
    std::vector<char> seen(mesh_.curves.size(), 0);
    for_each_edge(std::span(sides_), [&](std::span<const HalfEdge> edge) {
      const auto line = line_curve_.find({edge[0].lo, edge[0].hi});
      if (line == line_curve_.end() || seen[line->second]) return;
      seen[line->second] = 1;
      auto& faces = report_.curves[line->second].faces;
      for (const HalfEdge& side : edge) faces.push_back(mesh_.triangle_region[side.element]);
      std::ranges::sort(faces);
    });
    for (const CurveReport& curve : report_.curves)
      if (curve.faces.size() == 1) report_.free_length += curve.length;
  }

  void measure_faces() {
    report_.faces.resize(mesh_.regions.size());
    for (FaceReport& face : report_.faces) face.width = kInf;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const double area = norm(area_vector(mesh_, t)) / 2;
      report_.faces[mesh_.triangle_region[t]].area += area;
      report_.area += area;
    }
    std::vector<Chart> charts = extract_charts(mesh_, std::vector<char>(mesh_.triangles.size(), 1));
    std::ranges::stable_sort(charts, {}, &Chart::face);
    for (const Chart& chart : charts) add_chart(chart);
    for (std::size_t c = 0; c < report_.curves.size(); ++c)
      for (const int f : report_.curves[c].faces) {
        auto& curves = report_.faces[f].curves;
        if (curves.empty() || curves.back() != static_cast<int>(c)) curves.push_back(static_cast<int>(c));
      }
  }

  void add_chart(const Chart& chart) {
    FaceReport& face = report_.faces[chart.face];
    ++face.pieces;
    face.loops += static_cast<int>(chart.loops.size());
    face.handles += genus(chart);
    if (chart.loops.empty()) return;
    std::vector<Vec3> inwards(chart.n_boundary);  // direction at the side that begins at each vertex
    for (std::size_t t = 0; t < chart.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (chart.neighbours[t][k] >= 0) continue;
        const int a = chart.triangles[t][(k + 1) % 3], b = chart.triangles[t][(k + 2) % 3];
        const Vec3 side = chart.points[b] - chart.points[a];
        const Vec3 in = cross(cross(side, chart.points[chart.triangles[t][k]] - chart.points[a]), side);
        const double length = norm(in);
        if (length > 0) inwards[a] = (1 / length) * in;
      }
    std::vector<BoundarySide> sides;
    std::vector<std::array<int, 2>> sharp;
    const std::vector<double> defects = angle_defects(chart);
    double perimeter = 0;
    for (const auto& loop : chart.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int before = loop[i > 0 ? i - 1 : loop.size() - 1], a = loop[i],
                  b = loop[i + 1 < loop.size() ? i + 1 : 0];
        const int curve = curve_of(chart, a, b);
        sides.push_back({chart.points[a], chart.points[b], inwards[a], curve});
        perimeter += norm(chart.points[b] - chart.points[a]);
        if (!std::ranges::binary_search(model_.corners, chart.fine_node[a])) continue;
        const CornerReport corner{chart.face,
                                  {curve_of(chart, before, a), curve},
                                  chart.points[a],
                                  (std::numbers::pi - defects[a]) * 180 / std::numbers::pi};
        report_.corners.push_back(corner);
        if (corner.angle < kCornerAngle) sharp.push_back(sorted_ends(corner.curves[0], corner.curves[1]));
      }
    }
    std::ranges::sort(sharp);
    const std::vector<double> areas = triangle_areas(chart);
    const double diameter = 4 * std::accumulate(areas.begin(), areas.end(), 0.0) / perimeter;
    face.width = std::min({face.width, diameter, least_gap(sides, sharp)});
  }

  int curve_of(const Chart& chart, int a, int b) const {
    return line_curve_.at(sorted_ends(chart.fine_node[a], chart.fine_node[b]));
  }

  void find_shells() {
    const int n_faces = static_cast<int>(mesh_.regions.size());
    DisjointSets joined(n_faces);
    for (const CurveReport& curve : report_.curves)
      for (const int f : curve.faces) joined.join(curve.faces[0], f);
    const std::vector<int> shell_of = joined.places();
    for (int f = 0; f < n_faces; ++f) {
      if (shell_of[f] == std::ssize(report_.shells)) report_.shells.push_back({{}, 0, 0, true});
      ShellReport& shell = report_.shells[shell_of[f]];
      shell.faces.push_back(f);
      shell.area += report_.faces[f].area;
    }
    count_cells(shell_of);
  }

  void count_cells(const std::vector<int>& shell_of) {
    const auto shell_of_triangle = [&](int t) -> ShellReport& {
      return report_.shells[shell_of[mesh_.triangle_region[t]]];
    };
    for_each_edge(std::span(sides_), [&](std::span<const HalfEdge> edge) {
      ShellReport& shell = shell_of_triangle(edge[0].element);
      --shell.euler_characteristic;
      if (edge.size() < 2) shell.closed = false;
    });
    std::vector<int> last_shell(mesh_.points.size(), -1);  // so that shells count points once
    std::vector<std::vector<int>> triangles(report_.shells.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      triangles[shell_of[mesh_.triangle_region[t]]].push_back(static_cast<int>(t));
    for (std::size_t s = 0; s < triangles.size(); ++s)
      for (const int t : triangles[s]) {
        ++report_.shells[s].euler_characteristic;
        for (const int v : mesh_.triangles[t]) {
          if (last_shell[v] == static_cast<int>(s)) continue;
          last_shell[v] = static_cast<int>(s);
          ++report_.shells[s].euler_characteristic;
        }
      }
  }

  const SurfaceModel& model_;
  const Mesh& mesh_;
  std::vector<HalfEdge> sides_;
  std::map<std::array<int, 2>, int> line_curve_;  ///< curve of each line, by its ends
  ModelReport report_;
};

}  // namespace

ModelReport report_model(const SurfaceModel& model) { return Reporter(model).run(); }

std::string topology(const FaceReport& face) {
  std::string text;
  if (face.handles > 0) {
    text = counted(face.handles, "handle") + ", " + counted(face.loops, "loop");
  } else if (face.loops == 0) {
    text = "closed";
  } else {
    const int holes = face.loops - face.pieces;
    text = holes == 0 ? "disk" : holes == 1 ? "annulus" : fmt::format("disk with {} holes", holes);
  }
  return face.pieces > 1 ? fmt::format("{} pieces, {}", face.pieces, text) : text;
}

namespace {

std::string list_curves(const Mesh& mesh, const std::vector<char>& listed) {
  constexpr std::size_t kMostNamed = 10;
  std::vector<std::string> tags;
  for (std::size_t c = 0; c < listed.size(); ++c)
    if (listed[c]) tags.push_back(std::to_string(mesh.curves[c].tag));
  const auto first = std::ranges::find(listed, 1) - listed.begin();
  const auto line = std::ranges::find(mesh.line_curve, static_cast<int>(first)) - mesh.line_curve.begin();
  return fmt::format("{} ({}), the first through {}", tags.size(), first_of(tags, kMostNamed),
                     show_point(mesh.points[mesh.lines[line][0]]));
}

/// Returns whether all triangles lie in parallel planes, so that they can enclose nothing.
bool is_flat(const Mesh& mesh) {
  constexpr double kFlat = 1e-6;  // part of the largest area
  Vec3 largest;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (const Vec3 area = area_vector(mesh, t); norm(area) > norm(largest)) largest = area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (norm(cross(area_vector(mesh, t), largest)) > kFlat * dot(largest, largest)) return false;
  return true;
}

}  // namespace

void report_edges(SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::vector<char> free(mesh.curves.size(), 0), crowded(mesh.curves.size(), 0);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const std::size_t n = sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).size();
    if (n == 1) free[mesh.line_curve[l]] = 1;
    if (n > 2) crowded[mesh.line_curve[l]] = 1;
  }
  if (std::ranges::count(free, 1) > 0 && !is_flat(mesh))
    model.warnings.push_back("the surface is open: free curves: " + list_curves(mesh, free) +
                             "; a larger tolerance of welding closes gaps of a solid, a shell needs nothing");
  if (std::ranges::count(crowded, 1) > 0)
    model.warnings.push_back("more than two faces meet on curves: " + list_curves(mesh, crowded));
}

}  // namespace delquad
