// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "base/activity.h"
#include "delquad/mesher.h"
#include "features/curves/flat_model.h"
#include "features/curves/mesh_planar_curves.h"
#include "features/curves/surface_input.h"
#include "features/given/given_domain.h"
#include "features/given/given_surface.h"
#include "features/given/named_domain.h"
#include "features/sizes/size_warnings.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/planar/model_chain.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/model_report.h"
#include "io/cases/read_problem.h"

namespace delquad {
namespace {

/// Length of edges on planar curves, over the model's diagonal, and chords of each curve to find the
/// diagonal.
constexpr double kPlanarEdge = 1.0 / 2000;
constexpr int kChordsOfCurve = 200;

SurfaceModel load(const MeshProblem& problem) {
  const StageScope stage("reading");
  if (const auto* model = std::get_if<PlanarModel>(&problem.model)) {
    const double edge = kPlanarEdge * norm(box_of(*model, kChordsOfCurve).size());
    return flat_model(make_domain(*model, *make_constant_size(edge)), model->source);
  }
  if (const auto* lines = std::get_if<LineModel>(&problem.model))
    return flat_model(make_named_domain(lines->mesh, lines->surfaces, lines->source), lines->source);
  if (const auto* given = std::get_if<GivenMesh>(&problem.model)) {
    const double angle = problem.surface.feature_angle.value_or(kGivenFeatureAngle);
    SurfaceModel model = !kind_of(problem.model).in_plane
                             ? make_given_surface(*given, angle).model
                             : flat_model(make_given_domain(*given).domain, given->source);
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
