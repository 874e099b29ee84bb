// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/adapt/adapt.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/located.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

/// Largest error of fits of linear fields, over their greatest value.
constexpr double kNoError = 1e-12;
/// Larger values have powers of second derivatives that overflow.
constexpr double kMostValue = 1e90;
/// Tolerance for the wanted number of quads, or for the error on the new mesh, and limit of tried meshes.
constexpr double kNearWanted = 0.05;
constexpr int kMostMeshes = 3;

/// Returns whether the solution is linear, so that nothing can be adapted to it.
bool is_linear(const Recovery& solution, const std::string& name) {
  double most = 0;
  for (const double value : solution.values)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  if (most > kMostValue || (most > 0 && most < 1 / kMostValue))
    refuse("the field {} has values up to {:g}: expected between {:g} and {:g}, in a larger or smaller unit",
           name, most, 1 / kMostValue, kMostValue);
  return interpolation_error(solution, std::numeric_limits<double>::infinity()).whole <= kNoError * most;
}

/// Returns whether the problem has parts that need a size instead of a metric.
bool needs_size(const MeshProblem& problem) {
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  return !problem.layers.empty() || !problem.periodic.empty() || !problem.washers.empty() ||
         problem.symmetry.automatic || !problem.symmetry.planes.empty() || !problem.criteria.empty() ||
         std::ranges::any_of(problem.surface.embed, &EmbeddedLine::is_crack) ||
         (model != nullptr && std::ranges::any_of(model->curves, &ModelCurve::is_crack));
}

/// Refuses too few quads. Each curve needs an edge, and n edges around a mesh need at least n / 2 - 1 quads.
void require_quads(const PlanarModel& model, double quads) {
  std::size_t sides = 0;
  for (const ModelCurve& curve : model.curves) sides += 1 + curve.shape->fixed_parameters().size();
  const double least = std::ceil(static_cast<double>(sides) / 2) - 1;
  if (quads < std::max(1.0, least))
    refuse("{:g} quads: the {} sides of the outline need {:g} at least: expected more quads", quads, sides,
           std::max(1.0, least));
}

/// Replaces indices by the height, names and numbers of the mesh, see trace_mesh().
void take_names(const Mesh& from, Mesh& mesh) {
  for (Vec3& p : mesh.points)
    p.z = from.points[from.quads.empty() ? from.triangles[0][0] : from.quads[0][0]].z;
  const auto index = [](const Entity& entity) { return std::stoi(entity.names.at(0)); };
  for (int& curve : mesh.line_curve) curve = index(mesh.curves[curve]);
  for (std::vector<int>* list : {&mesh.triangle_region, &mesh.quad_region})
    for (int& region : *list) region = index(mesh.regions[region]);
  for (NamedPoint& named : mesh.named_points) named.entity = from.named_points[index(named.entity)].entity;
  mesh.curves = from.curves;
  mesh.regions = from.regions;
  mesh.unit = from.unit;
  if (std::ranges::find(mesh.line_curve, std::ssize(from.curves)) == mesh.line_curve.end()) return;
  int last_tag = 0;
  for (const Entity& curve : from.curves) last_tag = std::max(last_tag, curve.tag);
  mesh.curves.push_back({last_tag + 1, {}});
}

/// Returns a solution on another mesh, with its second derivatives there.
Recovery seen_on(const Recovery& solution, const Mesh& mesh) {
  Recovery seen;
  seen.mesh = mesh;
  seen.hessian.resize(mesh.points.size());
  for (double Tensor2::*part : {&Tensor2::xx, &Tensor2::xy, &Tensor2::yy}) {
    std::vector<double> values;
    for (const Tensor2& h : solution.hessian) values.push_back(h.*part);
    const std::vector<double> there = transfer_points(solution.mesh, values, mesh);
    for (std::size_t i = 0; i < there.size(); ++i) seen.hessian[i].*part = there[i];
  }
  return seen;
}

}  // namespace

Adapted adapt(const Mesh& mesh, const std::vector<NodalField>& fields, const AdaptSpec& spec,
              const MeshProblem* given, const Context& context) {
  require_planar(mesh, "the mesh of the solution");
  std::vector<Recovery> solutions, curved;
  std::vector<std::string> names;
  for (const NodalField& field : fields) {
    require_values(mesh, field.values, field.name);
    solutions.push_back(recover(mesh, field.values));
    names.push_back(field.name);
    if (!is_linear(solutions.back(), field.name)) curved.push_back(solutions.back());
  }
  if (curved.empty() && !fields.empty())
    refuse("{}: constant or linear: no mesh has an error, expected a field that bends",
           fmt::join(names, ", "));
  AdaptSpec wanted = spec;
  MeshProblem problem;
  if (given != nullptr)
    problem = *given;
  else
    problem.model = trace_mesh(mesh), problem.name = problem.where = "the mesh of the solution";
  problem.order = std::max(problem.order, mesh.order);
  problem.size = {};
  problem.seed = 0;  // a seed would turn the domain away from the solution
  problem.quads.reset();
  std::vector<Adapted::Error> errors;
  for (const Recovery& solution : solutions)
    errors.push_back({interpolation_error(solution, spec.norm).whole, gradient_error(solution).whole, 0});
  Adapted made;
  for (int meshes = 1;; ++meshes) {
    std::vector<Tensor2> metric = adapted_metric(mesh, curved, wanted);
    const double quads = wanted.quads > 0 ? wanted.quads : complexity_of(mesh, metric);
    const auto* model = std::get_if<PlanarModel>(&problem.model);
    if (meshes == 1 && model != nullptr) require_quads(*model, quads);
    if (spec.isotropic && needs_size(problem)) {
      std::vector<double> size;
      for (const Tensor2& m : metric) size.push_back(1 / std::sqrt(m.xx));
      problem.size.field = make_nodal_size(mesh, std::move(size));
      if (spec.gradation > 1) problem.size.gradation = std::log(spec.gradation);
    } else {
      problem.metric = {.limits = spec.limits, .gradation = spec.gradation, .complexity = quads};
      problem.metric.function = make_nodal_metric(mesh, std::move(metric));
    }
    made.result = delquad::mesh(problem, spec.quality, context);
    double most = 0;
    for (std::size_t f = 0; f < solutions.size(); ++f) {
      errors[f].after = interpolation_error(seen_on(solutions[f], made.result.mesh), spec.norm).whole;
      most = std::max(most, errors[f].after);
    }
    const auto n_quads = static_cast<double>(made.result.mesh.quads.size());
    const double more = spec.error > 0 ? most / spec.error : spec.quads / n_quads;
    if (std::abs(more - 1) < kNearWanted) break;
    if (meshes == kMostMeshes) {
      made.result.warnings.emplace_back(
          spec.error > 0
              ? fmt::format("an error of {:.3g} is expected, and {:.3g} was asked for", most, spec.error)
              : fmt::format("there are {} quads, and {:g} were asked for", n_quads, spec.quads));
      break;
    }
    wanted.quads = quads * more;
    wanted.error = 0;
  }
  made.errors = std::move(errors);
  if (given == nullptr) take_names(mesh, made.result.mesh);
  return made;
}

}  // namespace delquad
