// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/washers/planar_washers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

#include "features/washers/hole_rows.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/encloses.h"
#include "geometry/planar/model_chain.h"

namespace delquad {
namespace {

/// Chords of a curve.
constexpr int kCurveChords = 64;

/// A loop once around.
struct SampledLoop {
  std::vector<Vec2> points;
  std::vector<int> curves;      ///< one after the other
  std::vector<double> lengths;  ///< of each
};

std::vector<Vec2> sample(const Curve& curve, bool forward) {
  std::vector<double> at = curve.fixed_parameters();
  at.insert(at.begin(), 0);
  at.push_back(1);
  const int chords = std::max(1, kCurveChords / static_cast<int>(at.size() - 1));
  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (int k = 0; k < chords; ++k) points.push_back(curve.point(at[i] + k * (at[i + 1] - at[i]) / chords));
  points.push_back(curve.point(1));
  if (!forward) std::ranges::reverse(points);
  return points;
}

SampledLoop sample(const PlanarModel& model, const ModelChain& chain, std::vector<int> curves) {
  SampledLoop loop;
  int node = chain.curve_ends[curves[0]][0];
  while (!curves.empty()) {
    const auto next = std::ranges::find_if(
        curves, [&](int c) { return chain.curve_ends[c][0] == node || chain.curve_ends[c][1] == node; });
    const int curve = *next;
    curves.erase(next);
    const auto& ends = chain.curve_ends[curve];
    const bool forward = ends[0] == node;
    node = ends[forward ? 1 : 0];
    const std::vector<Vec2> points = sample(*model.curves[curve].shape, forward);
    double& length = loop.lengths.emplace_back(0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) length += norm(points[i + 1] - points[i]);
    loop.points.insert(loop.points.end(), points.begin(), points.end() - 1);
    loop.curves.push_back(curve);
  }
  return loop;
}

std::vector<Vec3> in_space(const std::vector<Vec2>& points) {
  std::vector<Vec3> lifted;
  for (const Vec2& x : points) lifted.push_back({x.x, x.y, 0});
  return lifted;
}

}  // namespace

MeshProblem with_planar_washers(MeshProblem problem, const SizeField& size, std::vector<Warning>& warnings) {
  const std::vector<WasherSpec> washers = std::exchange(problem.washers, {});
  const PlanarModel& model = std::get<PlanarModel>(problem.model);
  const ModelChain chain = chain_model(model);
  std::vector<SampledLoop> sampled;
  for (const ModelLoop& loop : chain.loops) sampled.push_back(sample(model, chain, loop.curves));
  std::vector<Hole> holes(chain.loops.size());
  std::vector<const WasherSpec*> of_hole(holes.size(), nullptr);
  std::vector<int> hole_of(model.curves.size(), -1);
  std::vector<double> diameters;
  for (std::size_t l = 0; l < holes.size(); ++l) {
    holes[l] = {in_space(sampled[l].points), sampled[l].lengths};
    const auto diameter = hole_diameter(holes[l].outline);
    // Loops without a name in others are holes, see regions_of_loops().
    const bool is_hole =
        chain.loops[l].region.empty() && std::ranges::any_of(sampled, [&](const SampledLoop& other) {
          return &other != &sampled[l] && encloses(other.points, sampled[l].points[0]);
        });
    if (!diameter || !is_hole) continue;
    diameters.push_back(holes[l].diameter = *diameter);
    of_hole[l] = washer_of(washers, holes[l]);
    if (of_hole[l] == nullptr) continue;
    for (const int c : sampled[l].curves) hole_of[c] = static_cast<int>(l);
  }
  warn_of_idle(washers, diameters, warnings);
  std::vector<HoleClearance::Wall> walls;
  for (std::size_t c = 0; c < model.curves.size(); ++c) {
    if (model.curves[c].is_gone) continue;
    const std::vector<Vec3> points = in_space(sample(*model.curves[c].shape, true));
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      walls.push_back({{points[i], points[i + 1]}, hole_of[c]});
  }
  for (const ModelPoint& p : model.points)
    walls.push_back({{Vec3{p.at.x, p.at.y, 0}, Vec3{p.at.x, p.at.y, 0}}});
  const HoleClearance room(std::move(walls));
  std::map<int, int> divided;  // edges of curves
  for (const CurveDivision& division : problem.divisions)
    for (const int c : entities_named(curve_entities(model), "curve", division.name))
      divided[c] = division.edges;
  for (std::size_t l = 0; l < holes.size(); ++l) {
    if (of_hole[l] == nullptr) continue;
    for (const int c : sampled[l].curves) holes[l].given.push_back(divided.contains(c) ? divided[c] : 0);
    const double there = rim_size(holes[l], *of_hole[l], problem.size, size, warnings);
    const auto rows = rows_around(holes[l], static_cast<int>(l), *of_hole[l], there, room, warnings);
    if (!rows) continue;
    std::vector<int> numbers;
    for (const int c : sampled[l].curves) numbers.push_back(c + 1);
    LayerSpec layer = layers_of(*rows, numbers, of_hole[l]->where);
    for (std::size_t i = 0; i < layer.on.size(); ++i)
      if (divided.emplace(sampled[l].curves[i], rows->edges[i]).second)
        problem.divisions.push_back({.name = layer.on[i], .edges = rows->edges[i], .where = layer.where});
    problem.layers.push_back(std::move(layer));
  }
  return problem;
}

}  // namespace delquad
