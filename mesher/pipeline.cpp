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
#include "features/curves/surface_input.h"
#include "features/metric/metric_plane.h"
#include "features/metric/metric_surface.h"
#include "features/symmetry/mirrored_surface.h"
#include "features/washers/planar_washers.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/planar/join_outlines.h"
#include "geometry/planar/leave_out_small.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/simplify_outlines.h"
#include "geometry/planar/snap_outlines.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/poor_quads.h"

namespace delquad {
namespace {

/// Adds the faces of the patches that have a reason to be left out; marks all that are.
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
  std::vector<char> left_out(prepared.boundary.regions.size(), 0);
  for (const FaceFailure& failure : result.failures)
    if (failure.face >= 0) left_out[failure.face] = 1;
  if (std::ranges::none_of(prepared.patches, [&](const PatchSetup& p) { return !left_out[p.region]; }))
    throw InputError("no face can be meshed: " + result.failures.at(0).reason);
  return left_out;
}

/// Refuses what images of meshes have no nodes for.
void check_order(const MeshingSetup& p) {
  if (p.settings.order == 1 || !p.surface) return;
  const char* other = p.surface->given                     ? "a mesh that is given"
                      : p.surface->mirrored                ? "planes of symmetry of a surface"
                      : !p.boundary.periodic_faces.empty() ? "periodic faces"
                                                           : nullptr;
  if (other != nullptr)
    throw InputError(fmt::format("{}: elements of order {} do not go with {}: expected order 1",
                                 p.settings.where, p.settings.order, other));
}

/// The steps of the kind of model.
std::unique_ptr<ModelSteps> steps_of(const MeshProblem& problem, const RetryHints& hints) {
  if (const auto* given = std::get_if<GivenMesh>(&problem.model)) {
    if (is_in_space(given->mesh)) return given_surface_steps(problem, *given);
    return planar_steps(problem, hints);
  }
  const bool is_planar =
      std::holds_alternative<PlanarModel>(problem.model) || std::holds_alternative<LineModel>(problem.model);
  return is_planar ? planar_steps(problem, hints) : surface_steps(problem, hints);
}

/// As it is asked for, of a planar model, before its curves make it smaller.
PointSize size_of(const MeshProblem& problem) {
  std::vector<Warning> of_size;
  return as_function(planar_base_size(problem.size, std::get<PlanarModel>(problem.model), of_size));
}

/// Tolerance for outlines of data, in sizes.
constexpr double kSimplify = 0.1;

/// Whether what is done to outlines of data, or is asked for, is to be done to this model.
bool is_requested(const MeshProblem& problem, const std::optional<double>& asked) {
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  if (model == nullptr || problem.metric.plane) return false;
  return asked ? *asked > 0 : std::ranges::any_of(model->curves, &ModelCurve::is_data);
}

MeshProblem snapped(MeshProblem problem, std::vector<Warning>& model_warnings) {
  constexpr int kChords = 64;
  auto& model = std::get<PlanarModel>(problem.model);
  const auto asked = std::exchange(problem.surface.weld_tolerance, 0);
  model = snap_outlines(std::move(model), asked.value_or(kCoincidence) * norm(box_of(model, kChords).size()),
                        asked.has_value(), model_warnings);
  return problem;
}

MeshProblem simplified(MeshProblem problem, std::vector<Warning>& model_warnings) {
  const double part = problem.surface.simplify.value_or(kSimplify);
  const PlanarModel& model = std::get<PlanarModel>(problem.model);
  std::vector<double> named(model.curves.size(), std::numeric_limits<double>::infinity());
  for (const NamedSize& size : problem.size.named)
    for (std::size_t c = 0; c < named.size(); ++c)
      if (size.size > 0 && model.curves[c].name == size.name) named[c] = std::min(named[c], size.size);
  const OutlineTolerance tolerance = [part, named, size = size_of(problem)](int curve, const Vec3& x) {
    return part * std::min(named[curve], size(x));
  };
  problem.model = simplify_outlines(std::move(std::get<PlanarModel>(problem.model)), tolerance,
                                    problem.surface.simplify.has_value(), model_warnings);
  problem.surface.simplify = 0;
  return problem;
}

/// The problem of a planar model without what is small in its outlines.
MeshProblem without_small_outlines(MeshProblem problem, std::vector<Warning>& model_warnings) {
  PlanarModel& model = std::get<PlanarModel>(problem.model);
  std::vector<Vec3> ends;
  std::vector<Entity> curves, regions;
  for (const ModelCurve& curve : model.curves) {
    const Vec2 end = curve.shape->point(0);
    ends.push_back({end.x, end.y, 0});
    curves.push_back({0, {curve.name}});
  }
  for (const ModelLoop& loop : model.loops) regions.push_back({0, {loop.region}});
  const double length = length_of_small(problem, ends);
  const double hole = std::max(length, std::numbers::pi * problem.surface.fill_holes);
  model = leave_out_small(std::move(model), {length, hole, names_that_stay(problem, curves, regions)},
                          model_warnings);
  problem.surface = {};
  return problem;
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
  const SurfaceSpec& s = problem.surface;
  const bool has_small = s.ignore_below > 0 || s.idealize || s.fill_holes > 0,
             is_to_be_snapped = is_requested(problem, s.weld_tolerance),
             is_to_be_simplified = is_requested(problem, s.simplify);
  if (std::holds_alternative<PlanarModel>(problem.model) &&
      (has_small || is_to_be_snapped || is_to_be_simplified || !problem.washers.empty())) {
    std::vector<Warning> model_warnings;
    MeshProblem other = is_to_be_snapped ? snapped(problem, model_warnings) : problem;
    if (is_to_be_simplified) other = simplified(std::move(other), model_warnings);
    for (ModelCurve& curve : std::get<PlanarModel>(other.model).curves) curve.is_data = false;
    if (has_small) other = without_small_outlines(std::move(other), model_warnings);
    if (!problem.washers.empty())
      other = with_planar_washers(std::move(other), size_of(problem), model_warnings);
    MeshingSetup prepared = prepare_problem(other, hints);
    prepared.plane.ignores_small = has_small;
    prepared.warnings.insert(prepared.warnings.begin(), model_warnings.begin(), model_warnings.end());
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

MeshResult run_pipeline(const MeshingSetup& prepared, const Word& word) {
  PipelineState state = begin_meshing(prepared);
  for (const Stage* stage : word.stages) run_stage(*stage, prepared, state);
  return finish_meshing(prepared, prepared.settings.name + " " + word.text, std::move(state));
}

void require_sound(const std::string& label, const MeshResult& result) {
  if (!result.soundness.accepted()) throw UnsoundError(label + ": " + result.soundness.complaint());
}

Mesh finish_patches(FinishContext& on) {
  run_finish_steps(FinishAt::kPatches, on);
  return assemble(on.prepared, on.state.nodes.points, on.state.patches, on.left_out, &on.result.log);
}

namespace {

/// Brings what was made in the flat plane of a metric to the domain's own.
void to_plane(const MeshingSetup& prepared, SurfaceNodes& nodes, Mesh& mesh) {
  Mesh curves = prepared.boundary;
  curves.points = std::move(nodes.points);
  for (Mesh* flat : {&curves, &mesh}) to_plane(*prepared.metric_plane, *flat);
  nodes.points = std::move(curves.points);
}

/// Tells how far nodes lie from a model as it was read, where what is small in it went.
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
  std::string word;
  for (const Stage* stage : state.stages) word += stage->letter;
  const Stopwatch measuring;
  measure_added_metrics(prepared, result.mesh, word, result.metrics);
  result.log.add_time("metrics", measuring.time());
  return std::move(on.result);
}

}  // namespace delquad
