// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/scaling/scale_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/size_by.h"
#include "delquad/error.h"
#include "geometry/mesh/model_kind.h"

namespace delquad {
namespace {

void scale_per_turn(double& per_turn, double factor) {
  if (per_turn > 0) per_turn = std::max(per_turn / factor, kLeastPerTurn);
}

/// A number of edges or rows, k times as many, but one at least; what is none stays, and is refused later.
int refined_number(double number, double k) {
  constexpr double kMost = 1e9;  // more than anything can have
  return static_cast<int>(std::clamp(std::round(k * number), std::min(number, 1.0), kMost));
}

/// Edges lie in those that there were, where k is whole.
void refine(CurveDivision& division, double k) {
  const int edges = refined_number(division.edges, k);
  division.progression = std::pow(division.progression, double(division.edges) / edges);
  division.edges = edges;
}

void refine(WasherSpec& washer, double k) {
  washer.rows = refined_number(washer.rows, k);
  washer.edges = 2 * refined_number(washer.edges / 2.0, k);
}

/// So do rows.
void refine(LayerSpec& layer, double k) {
  const std::vector<double> heights = layer_heights(layer);
  const int rows = refined_number(static_cast<double>(heights.size()), k);
  layer.growth = std::pow(layer.growth, static_cast<double>(heights.size()) / rows);
  layer.number = rows;
  layer.thickness = 0;
  layer.first = 1;
  layer.first = heights.back() / layer_heights(layer).back();
}

}  // namespace

MeshProblem with_scaled_sizes(MeshProblem problem, double factor) {
  SizeSpec& size = problem.size;
  const bool has_curvature = follows_curvature(size);
  if (size.field) size.field = scaled(factor, size.field);
  if (size.function)
    size.function = [factor, base = std::move(size.function)](std::span<const Vec3> points,
                                                              std::span<double> delta) {
      base(points, delta);
      for (double& d : delta) d *= factor;
    };
  for (SizeSource& source : size.sources) source.size_near *= factor, source.size_far *= factor;
  for (NamedSize& named : size.named) {
    named.size *= factor;
    named.growth *= factor;
    scale_per_turn(named.curvature, factor);
  }
  if (has_curvature && size.gradation == 0) size.gradation = kCurvatureGradation;
  size.gradation *= factor;
  scale_per_turn(size.curvature, factor);
  problem.metric.scale *= factor;
  size.min *= factor;
  size.max *= factor;
  return problem;
}

void require_free_sizes(const MeshProblem& problem, const std::string& asked) {
  if (const std::string* source = kind_of(problem.model).kept)
    throw InputError(fmt::format(
        "{}: {}: the lines of {} are kept, each as an edge: expected curves (in a model file, a polyline "
        "will do), a surface or CAD",
        problem.where, asked, *source));
}

MeshProblem refined(MeshProblem problem) {
  const double k = std::exchange(problem.refine, 1);
  if (k == 1) return problem;
  if (!(k > 0) || !std::isfinite(k))
    throw InputError(fmt::format("{}: refine {}: expected a finite number above 0", problem.where, k));
  if (problem.quads)
    throw InputError(
        problem.where +
        ": a number of quads says how fine the mesh is, and so does refine: expected one of both");
  require_free_sizes(problem, fmt::format("refine {}", k));
  for (CurveDivision& division : problem.divisions) refine(division, k);
  for (LayerSpec& layer : problem.layers) refine(layer, k);
  for (WasherSpec& washer : problem.washers) refine(washer, k);
  for (FilletRows& fillet : problem.fillet_rows) fillet.rows = refined_number(fillet.rows, k);
  return with_scaled_sizes(std::move(problem), 1 / k);
}

}  // namespace delquad
