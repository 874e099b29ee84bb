#include "features/washers/surface_washers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/text.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/nearest_on_regions.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Mean cosine of the angle between a face and the plane of a hole in it: a countersink is none.
constexpr double kLeastFlat = 0.8;
/// Points of a ring's outline for each edge, at least, and steps on the way there.
constexpr int kPointsAnEdge = 4, kSteps = 4;

/// A hole in a face, with what is known of it on the surface.
struct FaceHole : Hole {
  int face = -1;
  std::vector<int> curve_of;  ///< of each side
  std::vector<int> curves;    ///< of its parts
  std::vector<Vec3> into;     ///< at its points: into the face
};

using Edge = std::pair<int, int>;

std::map<Edge, int> curves_of_edges(const Mesh& mesh) {
  std::map<Edge, int> curve;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    curve[std::minmax(mesh.lines[l][0], mesh.lines[l][1])] = mesh.line_curve[l];
  return curve;
}

std::vector<Chart> charts_of(const Mesh& mesh) {
  return extract_charts(mesh, std::vector<char>(mesh.triangles.size(), 1));
}

/// A loop of a chart, from the beginning of a curve; its diameter is 0 where it is no hole. `into`: of each
/// side of the chart's loops, by its ends. `ends`: points at which curves begin.
FaceHole hole_of(const Chart& chart, std::vector<int> loop, const std::map<Edge, int>& curves,
                 const std::map<Edge, Vec3>& into, const std::set<int>& ends) {
  const std::size_t n = loop.size();
  const auto first = std::ranges::find_if(loop, [&](int v) { return ends.contains(chart.fine_node[v]); });
  if (first != loop.end()) std::ranges::rotate(loop, first);
  FaceHole hole;
  hole.face = chart.face;
  Vec3 area;
  double flat = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = chart.points[loop[i]], side = chart.points[loop[(i + 1) % n]] - a;
    hole.curve_of.push_back(
        curves.at(std::minmax(chart.fine_node[loop[i]], chart.fine_node[loop[(i + 1) % n]])));
    if (i == 0 || hole.curve_of[i] != hole.curves.back()) {
      hole.curves.push_back(hole.curve_of[i]);
      hole.parts.push_back(0);
    }
    hole.parts.back() += norm(side);
    hole.outline.push_back(a);
    area = area + cross(a - hole.outline[0], side);
    const Vec3 sum = into.at({loop[i], loop[(i + 1) % n]}) + into.at({loop[(i + n - 1) % n], loop[i]});
    hole.into.push_back((1 / norm(sum)) * sum);
  }
  for (std::size_t i = 0; i < n; ++i)
    flat +=
        dot(into.at({loop[i], loop[(i + 1) % n]}), cross(hole.outline[(i + 1) % n] - hole.outline[i], area)) /
        norm(area);
  if (flat >= kLeastFlat * hole.length()) hole.diameter = hole_diameter(hole.outline).value_or(0);
  return hole;
}

/// Unit vectors into a chart from the sides of its loops.
std::map<Edge, Vec3> ways_into(const Chart& chart) {
  std::map<Edge, Vec3> into;
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (chart.neighbours[t][k] >= 0) continue;
      const int a = chart.triangles[t][(k + 1) % 3], b = chart.triangles[t][(k + 2) % 3];
      const Vec3 d = cross(area_vector(chart.points, chart.triangles[t]), chart.points[b] - chart.points[a]);
      into[{a, b}] = (1 / norm(d)) * d;
    }
  return into;
}

/// Places at a distance from the parts of a hole, along the surface, those between two parts in both.
std::vector<std::vector<Vec3>> places_around(const FaceHole& hole, const HoleRows& rows,
                                             const SurfaceModel& model, const NearestOnRegions& regions) {
  const std::size_t n = hole.outline.size();
  const double distance = rows.rows * rows.height;
  const auto place = [&](std::size_t i, double t) {
    const std::size_t j = (i + 1) % n;
    Vec3 x = (1 - t) * hole.outline[i] + t * hole.outline[j], d = (1 - t) * hole.into[i] + t * hole.into[j];
    if (model.projector) x = model.projector->to_curve(hole.curve_of[i], x);
    for (int step = 0; step < kSteps; ++step) {
      const Vec3 to = x + (distance / kSteps / norm(d)) * d;
      const Vec3 next =
          model.projector ? model.projector->to_face(hole.face, to) : regions.place(hole.face, to);
      d = next - x;
      x = next;
    }
    return x;
  };
  std::vector<std::vector<Vec3>> parts;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 begin = place(i, 0);
    if (!parts.empty()) parts.back().push_back(begin);
    if (i == 0 || hole.curve_of[i] != hole.curve_of[i - 1]) parts.push_back({begin});
    const std::size_t p = parts.size() - 1;
    const double side = norm(hole.outline[(i + 1) % n] - hole.outline[i]);
    const int places = 1 + static_cast<int>(kPointsAnEdge * rows.edges[p] * side / hole.parts[p]);
    for (int k = 1; k < places; ++k) parts[p].push_back(place(i, double(k) / places));
  }
  parts.back().push_back(parts[0][0]);
  return parts;
}

/// The name that a part of a ring's outline has until it is found again; no name of a file has a line's end.
std::string mark(std::size_t ring, std::size_t part) { return fmt::format("\n{} {}", ring, part); }

}  // namespace

std::map<int, int> divided_curves(const Mesh& mesh, const std::vector<CurveDivision>& divisions) {
  std::map<int, int> edges;
  for (const CurveDivision& division : divisions)
    for (const int c : entities_named(mesh.curves, "curve", division.name)) edges[c] = division.edges;
  return edges;
}

void SurfaceWashers::plan(const std::vector<WasherSpec>& washers, const std::vector<CurveDivision>& divisions,
                          const PointSize& size, SurfaceModel& model) {
  if (washers.empty()) return;
  const Mesh& mesh = model.fine;
  const auto curves = curves_of_edges(mesh);
  std::set<int> ends;
  for (const std::vector<int>& points : points_of_curves(mesh)) ends.insert({points.front(), points.back()});
  std::vector<HoleRoom::Wall> loose;
  for (const LooseLine& line : model.loose)
    for (std::size_t i = 0; i < line.points.size(); ++i)
      loose.push_back({{line.points[i], line.points[std::min(i + 1, line.points.size() - 1)]}});
  std::map<int, int> edges = divided_curves(mesh, divisions);
  const NearestOnRegions regions(mesh);
  for (const Chart& chart : charts_of(mesh)) {
    check_cancelled();
    const auto into = ways_into(chart);
    std::vector<FaceHole> holes;
    std::vector<HoleRoom::Wall> walls = loose;
    for (const std::vector<int>& loop : chart.loops) {
      FaceHole hole = hole_of(chart, loop, curves, into, ends);
      const bool gets_rows = hole.diameter > 0 && washer_of(washers, hole) != nullptr;
      for (std::size_t i = 0; i < loop.size(); ++i)
        walls.push_back({{chart.points[loop[i]], chart.points[loop[(i + 1) % loop.size()]]},
                         gets_rows ? static_cast<int>(holes.size()) : -1});
      if (gets_rows) holes.push_back(std::move(hole));
    }
    if (holes.empty()) continue;
    const HoleRoom room(std::move(walls));
    for (std::size_t h = 0; h < holes.size(); ++h) {
      const FaceHole& hole = holes[h];
      const std::string& where = washer_of(washers, hole)->where;
      auto rows = rows_around(hole, static_cast<int>(h), *washer_of(washers, hole), size(hole.outline[0]),
                              room, model.warnings);
      if (!rows) continue;
      // Another face may have the same hole, and its curves may be divided.
      for (std::size_t i = 0; i < hole.curves.size(); ++i)
        rows->edges[i] = edges.try_emplace(hole.curves[i], rows->edges[i]).first->second;
      const auto parts = places_around(hole, *rows, model, regions);
      const std::string at = show_point(hole.middle());
      for (std::size_t i = 0; i < parts.size(); ++i)
        model.loose.push_back(
            {parts[i], {mark(rings_.size(), i)}, where + ": the ring around the hole at " + at});
      rings_.push_back({hole.face, hole.curves, *rows, where, at});
    }
  }
}

void SurfaceWashers::cut(SurfaceModel& model, std::vector<CurveDivision>& divisions,
                         MappedSpec& mapped) const {
  if (rings_.empty()) return;
  Mesh& mesh = model.fine;
  std::map<std::string, std::vector<int>> marked;
  std::set<int> outer;
  for (std::size_t c = 0; c < mesh.curves.size(); ++c) {
    auto& names = mesh.curves[c].names;
    if (names.empty() || names[0][0] != '\n') continue;
    marked[names[0]].push_back(static_cast<int>(c));
    outer.insert(static_cast<int>(c));
    names.clear();
  }
  std::erase_if(model.embedded, [&](const EmbeddedCurve& e) { return outer.contains(e.curve); });
  // Rings are the charts that just these curves bound.
  std::map<std::pair<int, std::set<int>>, Chart> charts;
  const auto curve_of = curves_of_edges(mesh);
  for (Chart& chart : charts_of(mesh)) {
    std::set<int> around;
    for (const std::vector<int>& loop : chart.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        around.insert(
            curve_of.at(std::minmax(chart.fine_node[loop[i]], chart.fine_node[loop[(i + 1) % loop.size()]])));
    const int face = chart.face;
    charts.insert_or_assign({face, std::move(around)}, std::move(chart));
  }
  int tag = 0;
  for (const Entity& face : mesh.regions) tag = std::max(tag, face.tag);
  EntityGroups origin = each_alone(mesh.regions.size());
  std::map<int, int> divided = divided_curves(mesh, divisions);
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    const Ring& ring = rings_[r];
    std::vector<int> curves = ring.curves;
    for (std::size_t i = 0; i < ring.curves.size(); ++i)
      if (const auto& found = marked[mark(r, i)]; found.size() == 1) curves.push_back(found[0]);
    const auto chart = charts.find({ring.face, {curves.begin(), curves.end()}});
    if (curves.size() < 2 * ring.curves.size() || chart == charts.end()) {
      model.warnings.push_back(
          {"holes without rows", 1,
           fmt::format("{}: the hole at {} gets no rows: its ring is not whole on one face", ring.where,
                       ring.at)});
      continue;
    }
    for (const int t : chart->second.fine_triangle)
      mesh.triangle_region[t] = static_cast<int>(mesh.regions.size());
    mesh.regions.push_back({++tag, mesh.regions[ring.face].names});
    origin.push_back({ring.face});
    mapped.rings.emplace_back(fmt::format("region_{}", tag), ring.rows.rows);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      outer.erase(curves[i]);
      const int n = ring.rows.edges[i % ring.curves.size()];
      if (divided.emplace(curves[i], n).second)
        divisions.push_back(
            {.name = fmt::format("curve_{}", mesh.curves[curves[i]].tag), .edges = n, .where = ring.where});
    }
  }
  const std::vector<EmbeddedCurve> embedded = model.embedded;
  regroup(model, mesh, origin, each_alone(mesh.curves.size()));
  model.embedded = embedded;
  if (outer.empty()) return;
  const Mesh former = mesh;
  keep_lines(mesh, [&](std::size_t l) { return !outer.contains(former.line_curve[l]); });
  tidy_model(model, former);
}

}  // namespace delquad
