// SPDX-License-Identifier: GPL-3.0-or-later
#include <numbers>
#include <utility>

#include "base/activity.h"
#include "delquad/mesher.h"
#include "features/curves/mesh_planar_curves.h"
#include "features/curves/surface_input.h"
#include "features/given/given_domain.h"
#include "features/given/given_surface.h"
#include "features/given/named_domain.h"
#include "features/sizes/size_warnings.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/planar/model_chain.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/model_report.h"
#include "io/cases/read_problem.h"

namespace delquad {
namespace {

/// Edges of planar curves, in diagonals of the model, which is seen by so many chords a curve.
constexpr double kPlanarEdge = 1.0 / 2000;
constexpr int kChordsOfCurve = 200;
/// Where a planar curve turns by more, its point counts as a corner.
constexpr double kTurn = 30 * std::numbers::pi / 180;

/// The regions of a domain, triangulated between the points of their boundary.
SurfaceModel as_model(const PlanarDomain& domain, const std::string& source) {
  SurfaceModel model;
  model.source = source;
  model.fine = domain.boundary;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const auto& node = domain.patches[p].point_node;
    for (const auto& [a, b, c] : constrained_delaunay(domain.patches[p]).triangles) {
      model.fine.triangles.push_back({node[a], node[b], node[c]});
      model.fine.triangle_region.push_back(domain.patch_region[p]);
    }
  }
  const Mesh& mesh = model.fine;
  std::vector<char> corner(mesh.points.size(), 0);
  mark_turns(mesh, kTurn, std::vector<char>(mesh.points.size(), 1), corner);
  std::vector<int> curve_at(mesh.points.size(), -1);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) {
      if (curve_at[v] >= 0 && curve_at[v] != mesh.line_curve[l]) corner[v] = 1;
      curve_at[v] = mesh.line_curve[l];
    }
  for (std::size_t v = 0; v < corner.size(); ++v)
    if (corner[v]) model.corners.push_back(static_cast<int>(v));
  return model;
}

SurfaceModel load(const MeshProblem& problem) {
  const StageScope stage("reading");
  if (const auto* model = std::get_if<PlanarModel>(&problem.model)) {
    const double edge = kPlanarEdge * norm(box_of(*model, kChordsOfCurve).size());
    return as_model(make_domain(*model, *make_constant_size(edge)), model->source);
  }
  if (const auto* lines = std::get_if<LineModel>(&problem.model))
    return as_model(make_named_domain(lines->mesh, lines->surfaces, lines->source), lines->source);
  if (const auto* given = std::get_if<GivenMesh>(&problem.model)) {
    const double angle = problem.surface.feature_angle.value_or(kGivenFeatureAngle);
    SurfaceModel model = !kind_of(problem.model).in_plane
                             ? make_given_surface(*given, angle).model
                             : as_model(make_given_domain(*given).domain, given->source);
    model.warnings.insert(model.warnings.begin(), given->notes.begin(), given->notes.end());
    return model;
  }
  return make_surface(problem);
}

}  // namespace

ModelInfo model_info(MeshProblem problem, double size) {
  SurfaceModel model = load(read_files(std::move(problem)));
  ModelReport report = report_model(model);
  if (size > 0) warn_of_large_size(*make_constant_size(size), model.fine, model.warnings);
  ModelInfo info{
      std::move(model.source), std::move(model.fine), std::move(model.warnings), std::move(report), {}};
  for (const LeftOutFace& part : model.left_out) info.left_out.push_back(part.reason);
  return info;
}

}  // namespace delquad
