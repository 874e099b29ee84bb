// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "algorithms/fields/tangent_metric.h"
#include "base/context.h"
#include "base/nearest_name.h"
#include "base/stopwatch.h"
#include "delquad/domain.h"
#include "delquad/mesher.h"
#include "features/crosses/size_aware.h"
#include "features/metric/metric_plane.h"
#include "features/metric/metric_surface.h"
#include "features/midsurface/opposite_sides.h"
#include "features/scaling/scale_sizes.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/mesh/split_polygon.h"
#include "geometry/patches/meshing_setup.h"
#include "io/cases/read_problem.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "metrics/judgement/poor_quads.h"
#include "metrics/judgement/soundness.h"
#include "metrics/metrics.h"
#include "metrics/surface/surface_report.h"

namespace delquad {
namespace {

/// Runs by the settings of the context, and reports steps as they begin.
class Steps {
 public:
  Steps(const Context& context, std::size_t steps)
      : context_(context),
        steps_(static_cast<double>(steps)),
        running_({.threads = context.threads, .cancel = context.cancel, .seconds = context.time_limit}) {}
  void begin(const std::string& stage) {
    check_cancelled();
    if (context_.progress) context_.progress({stage, static_cast<double>(begun_) / steps_});
    ++begun_;
  }

 private:
  const Context& context_;
  double steps_;
  RunScope running_;
  int begun_ = 0;
};

Prepared prepare_now(MeshProblem problem, Steps& steps) {
  steps.begin("boundary and fields");
  const Stopwatch reading;
  problem = read_files(std::move(problem));
  std::vector<Warning> of_metric;
  if (problem.metric.asks() && !problem.metric.plane) {
    check_metric(problem);
    if (problem.metric.function) problem = in_metric_plane(std::move(problem), of_metric);
  }
  problem = refined(std::move(problem));
  const TimeSpent time = reading.time();
  MeshingSetup made = problem.quads ? prepare_for_quads(problem) : prepare_problem(problem);
  StageLog log;
  log.add_time("read", time);
  add_times(made.times, log);
  made.times = std::move(log.times);
  made.warnings.insert(made.warnings.begin(), of_metric.begin(), of_metric.end());
  return {std::make_shared<const MeshProblem>(std::move(problem)),
          std::make_shared<const MeshingSetup>(std::move(made))};
}

void make_sound(const Pipeline& pipeline, Prepared& prepared, MeshResult& result) {
  if (result.soundness.sound()) return;
  const auto problem = std::make_shared<const MeshProblem>(prepared.problem());
  MeshingSetup best = prepared.inside();
  const auto anew = [&](const RetryHints& r) {
    if (r.size_part != 1) return prepare_problem(with_scaled_sizes(*problem, r.size_part), r);
    if (r.ignore_below == 0 && r.feature_angle == 0) return prepare_problem(*problem, r);
    MeshProblem other = *problem;
    if (r.feature_angle > 0) {
      if (other.surface.feature_angle) throw InputError(other.name + ": the feature angle is given");
      other.surface.feature_angle = r.feature_angle;
    } else {
      other.surface.ignore_below = r.ignore_below;
      other.options.set("curves.keep_named", true);
    }
    return prepare_problem(other, r);
  };
  refine_unsound(anew, pipeline, best, result);
  prepared = {problem, std::make_shared<const MeshingSetup>(std::move(best))};
}

MeshResult mesh_now(Prepared prepared, const Pipeline& pipeline, Steps& steps) {
  Meshing meshing(std::move(prepared));
  for (const Stage* stage : pipeline.stages) {
    steps.begin(stage->name);
    meshing.run(*stage);
  }
  steps.begin("metrics");
  MeshResult result = meshing.finish();
  if (result.soundness.accepted()) return result;
  const std::string complaint = result.soundness.complaint();
  result.warnings.emplace_back(complaint);
  const MeshProblem& problem = result.prepared.problem();
  if (problem.allow_unsound) return result;
  const std::string why = problem.name + " " + pipeline.text + ": " + complaint;
  throw UnsoundError(why, std::make_shared<const MeshResult>(std::move(result)));
}

/// Returns the pipeline of a quality; a given mesh is improved.
Pipeline pipeline_of_quality(const Quality& quality, MeshProblem& problem) {
  if (pipeline_start(problem.model) == PipelineStart::kGivenMesh) {
    problem = read_files(std::move(problem));
    const Mesh& given = std::get<GivenMesh>(problem.model).mesh;
    return parse_pipeline(given.quads.empty() ? "BCO" : "CO", PipelineStart::kGivenMesh);
  }
  if (!problem.cross.kind && problem.cross.text.empty()) problem.cross.kind = quality.cross;
  problem.options.set_absent(quality.options);
  return parse_pipeline(quality.pipeline);
}

/// Gives the elements of an improved mesh the thickness of the nearest given ones.
void keep_thickness(MeshResult& result) {
  const auto* given = std::get_if<GivenMesh>(&result.prepared.problem().model);
  if (given == nullptr || given->mesh.thickness.empty()) return;
  Mesh from = given->mesh;
  ReadNotes ignored;
  split_quads(from, ignored);
  const NearestTriangle nearest(from.points, from.triangles);
  Mesh& made = result.mesh;
  for_each_element(made, [&](int, const auto& v) {
    Vec3 sum;
    for (const int i : v) sum = sum + (1.0 / static_cast<double>(v.size())) * made.points[i];
    made.thickness.push_back(from.thickness[nearest.find(sum).triangle]);
  });
}

/// Moves meshes of thin bodies from one side half-way to the other, where quads are measured and checked
/// again.
void move_to_midsurface(MeshResult& result) {
  const MeshingSetup& prepared = result.prepared.inside();
  if (!prepared.surface || !prepared.surface->opposite || !result.soundness.sound()) return;
  prepared.surface->opposite->move_half_way(result.mesh);
  result.metrics = metrics_of(prepared, result.mesh, sorted_half_edges(result.mesh));
  Soundness moved = check_elements(prepared, result.mesh);
  for (std::string& reason : moved.reasons) result.soundness.reasons.push_back("half-way, " + reason);
}

/// The preparation comes first.
void add_preparation(MeshResult& result) {
  const Preparation& made = *result.prepared;
  StageLog log{made.times};
  add_times(result.log.times, log);
  result.log.times = std::move(log.times);
  result.warnings.insert(result.warnings.begin(), made.warnings.begin(), made.warnings.end());
}

}  // namespace

const char* version() { return DELQUAD_VERSION; }

struct Meshing::State {
  Prepared prepared;
  Pipeline pipeline = {};
  PipelineState patches = begin_meshing(prepared.inside());
};

Meshing::Meshing(Prepared prepared) : state_(new State{std::move(prepared)}) {}
Meshing::Meshing(Meshing&&) noexcept = default;
Meshing& Meshing::operator=(Meshing&&) noexcept = default;
Meshing::~Meshing() = default;

void Meshing::run(const Stage& stage) {
  run_stage(stage, state_->prepared.inside(), state_->patches);
  state_->pipeline.text += stage.letter;
  state_->pipeline.stages.push_back(&stage);
  state_->pipeline.result = stage.to;
}

Mesh Meshing::mesh() const {
  const MeshingSetup& prepared = state_->patches.now(state_->prepared.inside());
  std::vector<char> left_out = prepared.unselected;
  left_out.resize(prepared.boundary.regions.size());
  Mesh mesh = assemble(prepared, state_->patches.nodes.points, state_->patches.patches, left_out);
  if (prepared.metric_plane) to_plane(*prepared.metric_plane, mesh);
  return mesh;
}

MeshResult Meshing::finish() {
  Prepared prepared = std::move(state_->prepared);
  const Pipeline pipeline = std::move(state_->pipeline);
  MeshResult result = finish_meshing(prepared.inside(), prepared.problem().name + " " + pipeline.text,
                                     std::move(state_->patches));
  make_sound(pipeline, prepared, result);
  if (prepared.problem().quads)
    match_quad_count(
        [&](MeshProblem problem) {
          const RetryHints read = no_hints(prepared.inside());
          Prepared other(std::make_shared<const MeshProblem>(problem),
                         std::make_shared<const MeshingSetup>(prepare_problem(problem, read)));
          MeshResult run = run_pipeline(other.inside(), pipeline);
          make_sound(pipeline, other, run);
          return std::pair(std::move(other), std::move(run));
        },
        prepared, result);
  result.prepared = std::move(prepared);
  add_preparation(result);
  move_to_midsurface(result);
  keep_thickness(result);
  return result;
}

Prepared prepare(MeshProblem problem, const Context& context) {
  Steps steps(context, 1);
  return prepare_now(std::move(problem), steps);
}

MeshResult mesh(const Prepared& prepared, const std::string& text, const Context& context) {
  const Pipeline pipeline = parse_pipeline(text, pipeline_start(prepared.problem().model));
  Steps steps(context, pipeline.stages.size() + 1);
  return mesh_now(prepared, pipeline, steps);
}

MeshResult mesh(MeshProblem problem, const std::string& text, const Context& context) {
  const Quality* quality = find_quality(text);
  const Pipeline pipeline = quality != nullptr ? pipeline_of_quality(*quality, problem)
                                               : parse_pipeline(text, pipeline_start(problem.model));
  Steps steps(context, pipeline.stages.size() + 2);
  return mesh_now(prepare_now(std::move(problem), steps), pipeline, steps);
}

const std::vector<Quality>& quality_registry() {
  const auto best = Options()
                        .set("curves.round_holes", true)
                        .set("recombination.settled", 0.05)
                        .set("regularity.usual_quads", 4000LL);
  static const std::vector<Quality> registry = {
      {"fast", "DB", CrossKind::kBoundary},
      // Q and O move vertices after B, which need not settle before. Cavities are small and cost nothing.
      {"good", "DBQO", CrossKind::kSizeAware,
       Options()
           .set("recombination.settled", 0.05)
           .set("regularity.quads", 60)
           .set("regularity.rounds", 1)
           .set("regularity.tolerance", 0.0)
           .set("repair.across_cuts", false)},
      {"best", "DBQRO", CrossKind::kSizeAware, best},
      {"regular", "DBCQRO", CrossKind::kSizeAware, Options(best).set("regularity.weight", 3.0)},
  };
  return registry;
}

const Quality* find_quality(const std::string& name) {
  const auto at = std::ranges::find(quality_registry(), name, &Quality::name);
  return at == quality_registry().end() ? nullptr : &*at;
}

const Quality& quality_named(const std::string& name) {
  if (const Quality* quality = find_quality(name)) return *quality;
  std::vector<std::string> names;
  for (const Quality& q : quality_registry()) names.push_back(q.name);
  throw InputError(fmt::format("quality '{}': expected one of {}{}", name.substr(0, 40),
                               fmt::join(names, ", "), suggestion(name, names)));
}

const Preparation* Prepared::operator->() const { return made_.get(); }
bool Prepared::is_surface() const { return made_->surface != nullptr; }
std::size_t Prepared::n_patches() const { return made_->patches.size(); }
const PatchBoundary& Prepared::patch(std::size_t i) const { return made_->patches.at(i).boundary; }
const Mesh& Prepared::fine() const { return made_->surface->whole().fine; }
const std::vector<SurfaceCut>& Prepared::cuts() const { return made_->surface->cuts; }
std::vector<SharpCorner> Prepared::sharp_corners() const { return made_->sharp_corners(); }
MapReport Prepared::maps() const { return report_maps(maps_of(*made_->surface)); }
double Prepared::row_ends() const { return expected_row_ends(*made_); }

const TriPatch* Prepared::background() const {
  return made_->plane.background ? &made_->plane.background->triangles() : nullptr;
}

std::optional<NodalMetric> followed_metric(const Prepared& prepared) {
  if (!prepared.inside().metric_plane) return std::nullopt;
  const MetricPlane& plane = *prepared.inside().metric_plane;
  const TriPatch& tri = plane.plane.triangles();
  NodalMetric result{{}, plane.metric};
  Mesh& mesh = result.mesh;
  for (const Vec2& x : tri.points) mesh.points.push_back({x.x, x.y, 0});
  mesh.triangles = tri.triangles;
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  for (const MetricPlane::Segment& s : plane.segments) mesh.lines.push_back(s.vertices);
  mesh.line_curve.assign(mesh.lines.size(), 0);
  mesh.curves = mesh.regions = {{1, {}}};
  const double scale = scale_of(prepared.inside());
  for (Tensor2& m : result.at) m = times(1 / (scale * scale), m);
  return result;
}

std::vector<DomainCurve> domain_curves(const Prepared& prepared) {
  std::vector<DomainCurve> curves;
  for (const DomainPiece& piece : prepared.inside().plane.pieces) {
    curves.push_back({piece.shape, piece.from, piece.to, {piece.ends[0]}});
    std::vector<int>& nodes = curves.back().nodes;
    nodes.insert(nodes.end(), piece.nodes.begin(), piece.nodes.end());
    nodes.push_back(piece.ends[1]);
  }
  return curves;
}

MeshMetrics Prepared::metrics(const Mesh& made, const std::string& pipeline) const {
  MeshMetrics metrics = metrics_of(*made_, made, sorted_half_edges(made));
  measure_added_metrics(*made_, made, pipeline, metrics);
  return metrics;
}

MeshResult Prepared::measure(Mesh of_others) const {
  MeshResult result;
  result.mesh = std::move(of_others);
  const std::vector<HalfEdge> sides = sorted_half_edges(result.mesh);
  if (metric_of(*made_)) {
    result.metrics = metrics_of(*made_, result.mesh, sides);
  } else {  // its first quads are no layers of ours
    result.metrics = measure_builtin(result.mesh, made_->size.field.get(), made_->size.asked.get(), sides);
    add_misalignment(*made_, result.mesh, sides, result.metrics);
  }
  measure_added_metrics(*made_, result.mesh, "", result.metrics);
  result.soundness = check_elements(*made_, result.mesh);
  result.bad_elsewhere = static_cast<int>(
      std::ranges::count_if(quad_etas(result.mesh), [](double eta) { return eta < kBadEta; }));
  judge_by_criteria(*made_, true, result);
  result.prepared = *this;
  return result;
}

}  // namespace delquad
