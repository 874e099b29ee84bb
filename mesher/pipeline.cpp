// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "algorithms/regularity/regularity.h"
#include "base/activity.h"
#include "base/parallel_each.h"
#include "base/stopwatch.h"
#include "base/system.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/curves/compose_size.h"
#include "features/metric/metric_plane.h"
#include "features/metric/metric_surface.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/mesh/nearest_triangle.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/poor_quads.h"

namespace delquad {
namespace {

/// Adds the faces of patches with a reason to be left out. Returns for each region whether it is left out.
std::vector<char> collect_failures(const MeshingSetup& prepared, const std::vector<std::string>& reasons,
                                   MeshResult& result) {
  result.failures = prepared.failures;
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (!reasons[i].empty()) result.failures.push_back({prepared.patches[i].region, reasons[i]});
  if (prepared.surface && prepared.surface->mirrored)
    add_failures_of_images(*prepared.surface->mirrored, result.failures);
  for (const PeriodicFaces& pair : prepared.boundary.periodic_faces)
    if (std::ranges::count(result.failures, pair.master, &FaceFailure::face) > 0)
      result.failures.push_back(
          {pair.face, fmt::format("face {}: it has the mesh of face {}, which is left out",
                                  prepared.boundary.regions[pair.face].tag,
                                  prepared.boundary.regions[pair.master].tag)});
  std::ranges::stable_sort(result.failures, {}, &FaceFailure::face);
  std::vector<char> left_out = prepared.unselected;
  left_out.resize(prepared.boundary.regions.size(), 0);
  for (const FaceFailure& failure : result.failures)
    if (failure.face >= 0) left_out[failure.face] = 1;
  if (std::ranges::none_of(prepared.patches, [&](const PatchSetup& p) { return !left_out[p.region]; }))
    throw InputError("no face can be meshed: " + result.failures.at(0).reason);
  return left_out;
}

/// Refuses elements of higher order with features that have no nodes for them.
void check_order(const MeshingSetup& p) {
  if (p.settings.order == 1 || !p.surface) return;
  const char* other = p.surface->given                     ? "a mesh that is given"
                      : !p.boundary.periodic_faces.empty() ? "periodic faces"
                                                           : nullptr;
  if (other != nullptr)
    throw InputError(fmt::format("{}: elements of order {} do not go with {}: expected order 1",
                                 p.settings.where, p.settings.order, other));
}

/// Returns the steps for the kind of model.
std::unique_ptr<ModelSteps> steps_of(const MeshProblem& problem, const RetryHints& hints) {
  const ModelKind kind = kind_of(problem.model);
  if (kind.has_outlines() && is_symmetric(problem)) return surface_steps(problem, hints);
  if (kind.in_plane) return planar_steps(problem, hints);
  return kind.is_given ? given_surface_steps(problem) : surface_steps(problem, hints);
}

/// Returns options by which an irregular vertex may cost more, in larger cavities. Options that allow no cost
/// stay, and so does a requested number of quads of cavities.
Options with_factor(Options options, double factor) {
  constexpr double kMostTolerance = 100;
  const double tolerance = options.number("regularity.tolerance");  // the weight comes later
  if (tolerance == 0 || factor <= 1) return options;
  options.set("regularity.tolerance", std::min(factor * tolerance, kMostTolerance));
  if (options.find("regularity.quads") == nullptr) options.set("regularity.quads", kFarQuads);
  return options;
}

}  // namespace

// A problem becomes a mesh in these steps: model and size, maps, curves, patches with their fields. The
// stages of the pipeline follow, then the steps that finish the mesh, and its measures and messages. If the
// mesh is not sound, all begins again from the problem, with smaller sizes.

MeshingSetup run_model_steps(const MeshProblem& problem, ModelSteps& model) {
  MeshingSetup p;
  p.metric_plane = problem.metric.plane;
  p.settings = {problem.name,       problem.where, problem.options, problem.max_elements,
                problem.keep_going, problem.order, problem.criteria};
  const auto timed = [&](const char* time, const char* doing, void (ModelSteps::*step)(MeshingSetup&)) {
    const Stopwatch watch;
    const StageScope stage(doing);
    (model.*step)(p);
    p.times.emplace_back(time, watch.time());
  };
  timed("read", "reading", &ModelSteps::read);
  if (model.is_surface()) timed("maps", "maps", &ModelSteps::flatten);
  timed("curves", "boundary", &ModelSteps::mesh_curves);
  const bool has_large_faces =
      problem.surface.compounds != Compounds::kNone || std::holds_alternative<TriangleModel>(problem.model);
  // In large faces the ends of rows lie far apart.
  p.settings.options =
      with_factor(p.settings.options,
                  has_large_faces ? kMostPriceFactor
                                  : price_factor(regularity_options(problem.options), p.size.expected_quads));
  timed("fields", "fields", &ModelSteps::make_patches);
  return p;
}

RetryHints no_hints(const MeshingSetup& prepared) {
  return {.cad = prepared.surface ? prepared.surface->cad : nullptr};
}

MeshingSetup prepare_problem(const MeshProblem& problem, const RetryHints& hints) {
  check_problem(problem);
  check_criteria(problem.criteria);
  if (auto other = with_other_outlines(problem)) {
    MeshingSetup prepared = prepare_problem(other->problem, hints);
    prepared.plane.ignores_small = other->ignores_small;
    prepared.warnings.insert(prepared.warnings.begin(), other->warnings.begin(), other->warnings.end());
    return prepared;
  }
  MeshingSetup prepared = run_model_steps(problem, *steps_of(problem, hints));
  check_order(prepared);
  check_criteria(problem.criteria, prepared.boundary, requested_size(prepared));
  return prepared;
}

void add_times(const StepTimes& times, StageLog& log) {
  for (const auto& [step, time] : times) log.add_time(step, time);
}

MeshResult run_pipeline(const MeshingSetup& prepared, const Pipeline& pipeline) {
  PipelineState state = begin_meshing(prepared);
  for (const Stage* stage : pipeline.stages) run_stage(*stage, prepared, state);
  return finish_meshing(prepared, prepared.settings.name + " " + pipeline.text, std::move(state));
}

void require_sound(const std::string& label, const MeshResult& result) {
  if (!result.soundness.accepted()) throw UnsoundError(label + ": " + result.soundness.complaint());
}

Mesh finish_patches(FinishContext& on) {
  run_finish_steps(FinishAt::kPatches, on);
  return assemble(on.prepared, on.state.nodes.points, on.state.patches, on.left_out, &on.result.log);
}

namespace {

/// Maps nodes and mesh from the flat plane of a metric to the plane of the domain.
void to_plane(const MeshingSetup& prepared, SurfaceNodes& nodes, Mesh& mesh) {
  Mesh curves = prepared.boundary;
  curves.points = std::move(nodes.points);
  for (Mesh* flat : {&curves, &mesh}) to_plane(*prepared.metric_plane, *flat);
  nodes.points = std::move(curves.points);
}

/// Reports how far nodes lie from the model as it was read, if small details were removed.
void report_farthest_node(const MeshingSetup& prepared, MeshResult& result) {
  if (!prepared.surface || !prepared.surface->model.before || !has_finite_points(result.mesh)) return;
  const Mesh& fine = *prepared.surface->model.before;
  const NearestTriangle nearest(fine.points, fine.triangles);
  const std::vector<Vec3>& nodes = result.mesh.points;
  std::vector<double> distances(nodes.size());
  parallel_each(nodes.size(), [&](std::size_t i) { distances[i] = nearest.find(nodes[i]).distance; });
  const auto most = std::ranges::max_element(distances);
  result.warnings.push_back(
      {"farthest nodes", *most,
       fmt::format("{}: nodes lie up to {:.3g} from the model's triangulation as it was read, at {}",
                   prepared.settings.name, *most, show_point(nodes[most - distances.begin()]))});
}

}  // namespace

MeshResult finish_meshing(const MeshingSetup& given, const std::string& label, PipelineState state) {
  const MeshingSetup& prepared = state.now(given);
  FinishContext on{prepared, state, {}, {}, label};
  MeshResult& result = on.result;
  const Stopwatch watch;
  on.left_out = collect_failures(prepared, state.reasons, result);
  result.warnings = std::move(state.warnings);
  result.log = std::move(state.log);
  result.mesh = finish_patches(on);
  state.patches.clear();
  if (prepared.metric_plane) to_plane(prepared, state.nodes, result.mesh);
  run_finish_steps(FinishAt::kMesh, on);
  result.seconds = state.seconds + watch.seconds();
  measure(prepared, on.left_out, result);
  run_finish_steps(FinishAt::kMeasured, on);
  report_farthest_node(prepared, result);
  result.peak_memory = peak_memory();
  const BadQuads bad =
      judge_quads(prepared, label, result.mesh, result.metrics, result.warnings, result.soundness);
  result.bad_in_corners = bad.in_corners;
  const MetricAt metric = metric_of(prepared);
  result.bad_elsewhere =
      metric ? count_bad_quads(metric, label, result.mesh, result.warnings) : bad.elsewhere;
  judge_by_criteria(prepared, false, result);
  if (prepared.is_given_surface()) put_back_entities(*prepared.surface->given, result.mesh);
  std::string pipeline;
  for (const Stage* stage : state.stages) pipeline += stage->letter;
  const Stopwatch measuring;
  measure_added_metrics(prepared, result.mesh, pipeline, result.metrics);
  result.log.add_time("metrics", measuring.time());
  return std::move(on.result);
}

}  // namespace delquad
