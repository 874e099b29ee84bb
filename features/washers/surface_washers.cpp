// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/washers/surface_washers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/cancel.h"
#include "base/text.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Mean cosine of the angle between a face and the plane of a hole in it: a countersink is none.
constexpr double kLeastFlat = 0.8;
/// Ends of a bore have lengths within this ratio.
constexpr double kMostTaper = 1.25;

/// A hole in a face, with what is known of it on the surface.
struct FaceHole : Hole {
  int face = -1;
  std::vector<int> curves;  ///< of its parts
};

using Edge = std::pair<int, int>;

/// A loop of a chart, from the beginning of a curve; its diameter is 0 where it is no hole. `into`: of each
/// side of the chart's loops, by its ends. `ends`: points at which curves begin.
FaceHole hole_of(const OutlinedChart& chart, std::size_t l, const std::map<Edge, Vec3>& into,
                 const std::set<int>& ends) {
  std::vector<int> loop = chart.loops[l];
  FaceHole hole;
  std::vector<int> curve_of = chart.curve_of[l];  // of each side
  hole.face = chart.face;
  const std::size_t n = loop.size();
  const auto first = std::ranges::find_if(loop, [&](int v) { return ends.contains(chart.fine_node[v]); });
  std::ranges::rotate(curve_of, curve_of.begin() + (first - loop.begin()) % std::ssize(loop));
  if (first != loop.end()) std::ranges::rotate(loop, first);
  Vec3 area;
  double flat = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = chart.points[loop[i]], side = chart.points[loop[(i + 1) % n]] - a;
    if (i == 0 || curve_of[i] != hole.curves.back()) {
      hole.curves.push_back(curve_of[i]);
      hole.parts.push_back(0);
    }
    hole.parts.back() += norm(side);
    hole.outline.push_back(a);
    area = area + cross(a - hole.outline[0], side);
  }
  for (std::size_t i = 0; i < n; ++i)
    flat +=
        dot(into.at({loop[i], loop[(i + 1) % n]}), cross(hole.outline[(i + 1) % n] - hole.outline[i], area)) /
        norm(area);
  if (flat >= kLeastFlat * hole.length()) hole.diameter = hole_diameter(hole.outline).value_or(0);
  return hole;
}

/// Unit vectors into a chart from the sides of its loops.
std::map<Edge, Vec3> inward_normals(const Chart& chart) {
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

std::vector<HoleClearance::Wall> walls_of(const std::vector<LooseLine>& loose) {
  std::vector<HoleClearance::Wall> walls;
  for (const LooseLine& line : loose)
    for (std::size_t i = 0; i < line.points.size(); ++i)
      walls.push_back({{line.points[i], line.points[std::min(i + 1, line.points.size() - 1)]}});
  return walls;
}

}  // namespace

std::vector<OutlinedChart> outlined_charts(const Mesh& mesh) {
  std::map<Edge, int> curve;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    curve[std::minmax(mesh.lines[l][0], mesh.lines[l][1])] = mesh.line_curve[l];
  std::vector<OutlinedChart> outlined;
  for (Chart& chart : extract_charts(mesh, std::vector<char>(mesh.triangles.size(), 1))) {
    OutlinedChart& made = outlined.emplace_back(OutlinedChart{std::move(chart)});
    for (const std::vector<int>& loop : made.loops) {
      auto& curves = made.curve_of.emplace_back();
      for (std::size_t i = 0; i < loop.size(); ++i)
        curves.push_back(
            curve.at(std::minmax(made.fine_node[loop[i]], made.fine_node[loop[(i + 1) % loop.size()]])));
    }
  }
  return outlined;
}

std::vector<SurfaceWashers::FacingSides> SurfaceWashers::facing_sides(const OutlinedChart& chart) {
  std::vector<std::vector<int>> sides;
  for (std::size_t l = 0; l < chart.loops.size(); ++l) {
    const std::vector<int>& loop = chart.loops[l];
    const std::size_t n = loop.size();
    const auto at = [&](std::size_t i) { return chart.points[loop[i % n]]; };
    const auto is_corner = [&](std::size_t i) {
      return turn_angle(at(i + n - 1), at(i), at(i + 1)) > kMostTurn;
    };
    std::size_t first = 0;
    while (first < n && !is_corner(first)) ++first;
    for (std::size_t i = first; i < first + n; ++i) {
      if (i == first || is_corner(i)) sides.emplace_back();
      const int curve = chart.curve_of[l][i % n];
      if (std::ranges::find(sides.back(), curve) == sides.back().end()) sides.back().push_back(curve);
    }
  }
  if (chart.loops.size() * sides.size() != 4) return {};
  std::vector<FacingSides> facing{{chart.face, {sides[0], sides[sides.size() / 2]}}};
  if (sides.size() == 4) facing.push_back({chart.face, {sides[1], sides[3]}});
  return facing;
}

void SurfaceWashers::find_divided() {
  edges_.clear();
  for (const CurveDivision& division : divisions_)
    for (const int c : entities_named(model_.fine.curves, "curve", division.name)) edges_[c] = division.edges;
}

void SurfaceWashers::divide(int curve, int edges, const std::string& where) {
  if (!edges_.emplace(curve, edges).second) return;
  divisions_.push_back(
      {.name = fmt::format("curve_{}", model_.fine.curves[curve].tag), .edges = edges, .where = where});
  ++n_added_;
}

bool SurfaceWashers::are_rims(const std::vector<int>& side) const {
  return std::ranges::all_of(side, [&](int c) { return rims_.contains(c); });
}

void SurfaceWashers::spread(const std::vector<FacingSides>& facing, double size, const std::string& where) {
  const std::vector<double> lengths = lengths_of_curves(model_.fine);
  for (std::size_t before = 0; before < rims_.size();) {
    before = rims_.size();
    for (const FacingSides& f : facing)
      for (const int k : {0, 1}) {
        const std::vector<int>&from = f.sides[k], &to = f.sides[1 - k];
        if (!are_rims(from) || std::ranges::any_of(to, [&](int c) { return edges_.contains(c); })) continue;
        Hole end;
        double length = 0;
        int edges = 0;
        for (const int c : to) end.parts.push_back(lengths[c]);
        for (const int c : from) length += lengths[c], edges += edges_.at(c);
        const auto [least, most] = std::minmax({length, end.length()});
        if (most > kMostTaper * least || edges < static_cast<int>(to.size()) ||
            !edge_fits(end.length() / edges, size))
          continue;
        const std::vector<int> shares = share_edges(end.parts, edges);
        for (std::size_t i = 0; i < to.size(); ++i) divide(to[i], shares[i], where), rims_.insert(to[i]);
      }
  }
}

void SurfaceWashers::plan(const SizeField& size) {
  if (problem_.washers.empty()) return;
  const Mesh& mesh = model_.fine;
  find_divided();
  std::set<int> ends;
  for (const std::vector<int>& points : points_of_curves(mesh)) ends.insert({points.front(), points.back()});
  const std::vector<HoleClearance::Wall> loose = walls_of(model_.loose);
  const std::vector<OutlinedChart> charts = outlined_charts(mesh);
  std::vector<FacingSides> facing;
  std::vector<int> n_faces(mesh.curves.size(), 0);
  for (const OutlinedChart& chart : charts) {
    for (FacingSides& f : facing_sides(chart)) facing.push_back(std::move(f));
    std::set<int> around;
    for (const auto& curves : chart.curve_of) around.insert(curves.begin(), curves.end());
    for (const int c : around) ++n_faces[c];
  }
  std::vector<double> diameters;
  for (const OutlinedChart& chart : charts) {
    check_cancelled();
    const auto into = inward_normals(chart);
    std::vector<FaceHole> holes;
    std::vector<HoleClearance::Wall> walls = loose;
    for (std::size_t l = 0; l < chart.loops.size(); ++l) {
      const std::vector<int>& loop = chart.loops[l];
      FaceHole hole = hole_of(chart, l, into, ends);
      if (hole.diameter > 0) diameters.push_back(hole.diameter);
      const bool gets_rows = hole.diameter > 0 && washer_of(problem_.washers, hole) != nullptr;
      for (std::size_t i = 0; i < loop.size(); ++i)
        walls.push_back({{chart.points[loop[i]], chart.points[loop[(i + 1) % loop.size()]]},
                         gets_rows ? static_cast<int>(holes.size()) : -1});
      if (gets_rows) holes.push_back(std::move(hole));
    }
    if (holes.empty()) continue;
    const HoleClearance room(std::move(walls));
    for (std::size_t h = 0; h < holes.size(); ++h) {
      FaceHole& hole = holes[h];
      const WasherSpec& washer = *washer_of(problem_.washers, hole);
      for (const int c : hole.curves) {
        hole.given.push_back(edges_.contains(c) ? edges_[c] : 0);
        hole.is_rim |= n_faces[c] > 1;
      }
      const double there = rim_size(hole, washer, problem_.size, size, model_.warnings);
      auto rows = rows_around(hole, static_cast<int>(h), washer, there, room, model_.warnings);
      if (!rows) continue;
      for (std::size_t i = 0; i < hole.curves.size(); ++i) {
        divide(hole.curves[i], rows->edges[i], washer.where);
        rows->edges[i] = edges_.at(hole.curves[i]);
        rims_.insert(hole.curves[i]);
      }
      spread(facing, there, washer.where);
      std::vector<int> numbers;
      for (const int c : hole.curves) numbers.push_back(mesh.curves[c].tag);
      LayerSpec& layer = layers_.emplace_back(layers_of(*rows, numbers, washer.where));
      layer.into = {fmt::format("region_{}", mesh.regions[hole.face].tag)};
    }
  }
  warn_of_idle(problem_.washers, diameters, model_.warnings);
  for (const FacingSides& f : facing)
    if (are_rims(f.sides[0]) && are_rims(f.sides[1]))
      mapped_.rings.emplace_back(fmt::format("region_{}", mesh.regions[f.face].tag), -1);
}

bool SurfaceWashers::give_way(const FaceError& error) {
  const Mesh& mesh = model_.fine;
  std::set<std::string> around;
  for (const OutlinedChart& chart : outlined_charts(mesh))
    for (const auto& curves : chart.curve_of)
      for (const int c : curves)
        if (chart.face == error.face()) around.insert(fmt::format("curve_{}", mesh.curves[c].tag));
  const auto gone = std::remove_if(divisions_.end() - n_added_, divisions_.end(),
                                   [&](const CurveDivision& d) { return around.contains(d.name); });
  const std::ptrdiff_t n_gone = divisions_.end() - gone;
  const auto first = layers_.begin() + std::ssize(problem_.layers);
  layers_.erase(std::remove_if(first, layers_.end(),
                               [&](const LayerSpec& layer) { return around.contains(layer.on.front()); }),
                layers_.end());
  divisions_.erase(gone, divisions_.end());
  n_added_ -= n_gone;
  if (n_gone > 0)
    model_.warnings.push_back(
        {"faces without rows around holes and across fillets", 1,
         fmt::format("{}: its curves get no rows around holes or across fillets", error.what())});
  return n_gone > 0;
}

}  // namespace delquad
