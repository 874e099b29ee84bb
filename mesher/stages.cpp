// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <stdexcept>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/insertion/linf_adaptation.h"
#include "algorithms/layout/layout.h"
#include "algorithms/recombination/merge_cost.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/activity.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "features/given/given_worst.h"
#include "geometry/patches/places_inside.h"
#include "mesher/finish_steps.h"
#include "metrics/shape.h"
#include "smoothing/cvt/smooth_points.h"
#include "smoothing/optimisation/planar_tracks.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "smoothing/surface/surface_tracks.h"

namespace delquad {
bool has_duplicate_quads(const QuadPatch& mesh, const std::vector<int>& point_node) {
  std::vector<int> nodes = point_node;
  std::ranges::sort(nodes);
  if (std::ranges::adjacent_find(nodes) == nodes.end()) return false;
  std::vector<std::array<int, 4>> quads = mesh.quads;
  const int n_nodes = nodes.back() + 1;
  for (auto& quad : quads) {
    for (int& v : quad) v = v < mesh.n_boundary ? point_node[v] : n_nodes + v;
    std::ranges::sort(quad);
  }
  std::ranges::sort(quads);
  return std::ranges::adjacent_find(quads) != quads.end();
}

namespace {

/// Calls work(summary), and adds the summary and the seconds to the log.
template <class Summary, class Work>
void log_step(StageLog& log, const char* step, const Work& work) {
  const Stopwatch watch;
  Summary summary;
  work(summary);
  add_summary(log, summary);
  log.add_time(step, watch.time());
}

/// Inserts points by `mesh`: mesh_frontal, mesh_delquad or mesh_packing.
void insert_points(decltype(mesh_frontal)& mesh, const PointPlacement& placement, const StageInput& in,
                   PatchMesh& patch, StageLog& log) {
  FrontalOptions options = insertion_options(in.options);
  options.max_points = in.max_points;
  log_step<FrontalSummary>(log, "insertion", [&](FrontalSummary& summary) {
    patch.triangles = mesh(in.boundary, placement, in.cross, in.size, options, &summary);
    if (summary.termination == FrontalTermination::kMaxPoints)
      throw TooManyPoints(
          fmt::format("insertion stopped at {} points, the most that {} elements (max-elements) allow",
                      summary.inserted, in.max_points / kPointsPerElement));
  });
  patch.form = PatchForm::kTriangles;
}

void smooth_triangles(const StageInput& in, PatchMesh& patch, StageLog& log) {
  log_step<SmoothingSummary>(log, "smoothing", [&](SmoothingSummary& summary) {
    patch.triangles =
        smooth_points(patch.triangles, in.cross, in.size, smoothing_options(in.options), &summary);
  });
}

/// Counts patches whose treatment (except relocation) or clean-up was undone, since it left two quads around
/// a tube.
void note_discarded(bool treatment, bool cleanup, StageLog& log) {
  log.summaries.add("discarded", {{"treatments", static_cast<long long>(treatment)},
                                  {"cleanups", static_cast<long long>(cleanup)}});
}

/// Replaces the triangles of a patch by the quads that `merge` returns.
template <class Merge>
void merge_by(PatchMesh& patch, StageLog& log, const Merge& merge) {
  log_step<RecombineSummary>(log, "matching", [&](RecombineSummary& summary) {
    patch.quads = merge(summary);
    patch.triangles = {};
    patch.form = PatchForm::kQuads;
  });
}

void merge_triangles(const StageInput& in, PatchMesh& patch, StageLog& log) {
  const StageScope matching("matching");
  const RecombinationOptions options = recombination_options(in.options);
  merge_by(patch, log, [&](RecombineSummary& summary) {
    const bool misaligned = is_misaligned(in.boundary, in.cross, in.size);
    return recombine(patch.triangles, *matching_solver(options.solver, in.options), &summary,
                     misaligned ? kMisalignedExtraEdgeCost : kExtraEdgeCost, added_cost(options.cost, in));
  });
  if (options.treatment == Treatment::kNone) return;

  const StageScope treating("treatment");
  log_step<TreatmentSummary>(log, "treatment", [&](TreatmentSummary& treated) {
    TreatmentOptions treatment_options{.settled = options.settled};
    QuadPatch result = treat_paper(patch.quads, in.size, treatment_options, &treated);
    const bool discarded = has_duplicate_quads(result, in.boundary.point_node);
    if (discarded) {
      treatment_options.max_rounds = 0;
      const double in_vain = treated.seconds;
      result = treat_paper(patch.quads, in.size, treatment_options, &treated);
      treated.seconds += in_vain;
    }
    patch.quads = std::move(result);
    note_discarded(discarded, false, log);
  });
}

void merge_greedily(PatchMesh& patch, StageLog& log, const GreedyOptions& options) {
  merge_by(patch, log,
           [&](RecombineSummary& summary) { return recombine_greedily(patch.triangles, options, &summary); });
}

void merge_and_treat(const StageInput& in, PatchMesh& patch, StageLog& log) {
  merge_greedily(patch, log, {});
  const RecombinationOptions options = recombination_options(in.options);
  if (options.treatment == Treatment::kNone) return;
  const StageScope treating("treatment");
  log_step<TreatmentSummary>(log, "treatment", [&](TreatmentSummary& treated) {
    patch.quads = treat_by_degrees(patch.quads, in.size, {}, &treated);
  });
}

void adapt_and_merge(const StageInput& in, PatchMesh& patch, StageLog& log) {
  AdaptationOptions options;
  options.max_points = in.max_points;
  log_step<AdaptationSummary>(log, "adaptation", [&](AdaptationSummary& summary) {
    patch.triangles = adapt_linf(patch.triangles, in.cross, in.size, options, &summary);
  });
  constexpr double kGoodPair = 0.5;  // eta
  merge_greedily(patch, log, {kGoodPair, true, 0});
}

/// Fills cavities of a patch, unless the result closes too tightly. `key` names the stage in records.
void fill_cavities(const RegularityOptions& options, const char* key, const char* step, const StageInput& in,
                   PatchMesh& patch, StageLog& log) {
  const Stopwatch watch;
  RegularitySummary summary;
  QuadPatch result = make_regular(patch.quads, in.size, options, &summary);
  const bool discarded = has_duplicate_quads(result, in.boundary.point_node);
  if (!discarded) patch.quads = std::move(result);
  // Discarded work changed nothing, but took its time.
  if (discarded)
    summary = {.irregular_before = summary.irregular_before,
               .irregular_after = summary.irregular_before,
               .seconds = summary.seconds};
  log.summaries.add(key, fields_of(summary));
  log.add_time(step, watch.time());
  note_discarded(false, discarded, log);
}

void clean_up_quads(const StageInput& in, PatchMesh& patch, StageLog& log) {
  fill_cavities(without_price(regularity_options(in.options)), "cleanup", "clean-up", in, patch, log);
}

void make_quads_regular(const StageInput& in, PatchMesh& patch, StageLog& log) {
  fill_cavities(regularity_options(in.options), "regularity", "regularity", in, patch, log);
}

void lay_out_where_better(const StageInput& in, PatchMesh& patch, StageLog& log) {
  if (count_irregular(patch.quads) == 0 || !patch.quads.triangles.empty()) return;
  log_step<LayoutSummary>(log, "layout", [&](LayoutSummary& summary) {
    auto mesh = more_regular(patch.quads, in.boundary, in.cross, in.size,
                             regularity_options(in.options).tolerance, &summary);
    if (mesh && has_duplicate_quads(*mesh, in.boundary.point_node)) mesh = std::nullopt, summary.worse = 1;
    if (mesh) patch.quads = *std::move(mesh);
  });
}

void untangle_quads(const StageInput& in, PatchMesh& patch, StageLog& log) {
  log_step<OptimisationSummary>(log, "optimisation", [&](OptimisationSummary& summary) {
    summary.untangled = untangle_flat(patch.quads, in.size);
  });
}

/// Returns a point of space; `z` is the height of planar meshes.
Vec3 as_place(const Vec2& p, double z) { return {p.x, p.y, z}; }
Vec3 as_place(const Vec3& p, double) { return p; }

/// Moves vertices back, first by half of the way, if their quads are worse than the worst given quad.
/// Vertices of quads that were unsound before stay where they are, as do vertices near quads that are still
/// unsound.
template <class Vec>
void forbid_degradation(const MeshingSetup& prepared, const std::vector<Vec>& before,
                        const std::vector<Vec2>& positions, const std::vector<std::array<int, 4>>& quads,
                        VertexTracks<Vec>& tracks, std::vector<Vec>& points) {
  constexpr double kLeastPart = 1.0 / 64;
  constexpr int kNear = 2;  // rings of quads
  const auto corners = [&](const std::vector<Vec>& at, const std::array<int, 4>& quad) {
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k) x[k] = as_place(at[quad[k]], prepared.boundary.points[0].z);
    return x;
  };
  std::vector<char> stays(points.size(), 0);
  const auto stay_at_unsound = [&](const std::vector<Vec>& at) {
    for (const auto& quad : quads) {
      const auto x = corners(at, quad);
      const Vec3 normal = prepared.surface ? area_vector(x) : Vec3{0, 0, 1};
      if (is_sound_quad(x, normal, element_shape(x, normal))) continue;
      for (const int v : quad) stays[v] = 1;
    }
  };
  stay_at_unsound(points);
  for (int ring = 0; ring < kNear; ++ring) {
    const std::vector<char> nearer = stays;
    for (const auto& quad : quads)
      if (std::ranges::any_of(quad, [&](int v) { return nearer[v] != 0; }))
        for (const int v : quad) stays[v] = 1;
  }
  stay_at_unsound(before);
  std::vector<double> part(points.size(), 1);  // part of its way that each vertex keeps
  std::vector<Vec2> ways;
  for (std::size_t v = 0; v < points.size(); ++v)
    ways.push_back(tracks.position(static_cast<int>(v)) - positions[v]);
  for (bool again = true; again;) {
    again = false;
    for (const auto& quad : quads) {
      if (!is_beyond_given(prepared, corners(points, quad))) continue;
      for (const int v : quad) {
        if (stays[v] != 0 || !(norm(points[v] - before[v]) > 0)) continue;
        again = true;
        part[v] = part[v] > kLeastPart ? part[v] / 2 : 0;
        const Vec at = tracks.put(v, positions[v] + part[v] * ways[v]);
        points[v] = part[v] > 0 ? at : before[v];
      }
    }
  }
}

/// Optimizes vertices; on a given mesh forbid_degradation() follows.
template <class Vec>
OptimisationSummary optimise(const AllPatches& in, std::vector<Vec>& points,
                             const std::vector<std::array<int, 4>>& quads, VertexTracks<Vec>& tracks) {
  const bool keep = in.began_from_given && in.prepared.given_worst && repair_options(in.options).keep_given;
  const std::vector<Vec> before = points;
  std::vector<Vec2> positions;
  for (std::size_t v = 0; keep && v < points.size(); ++v)
    positions.push_back(tracks.position(static_cast<int>(v)));
  OptimisationOptions options = optimisation_options(in.options);
  options.limits = in.prepared.settings.limits;
  const auto summary = optimise_on_tracks(points, quads, tracks, options);
  if (keep) forbid_degradation(in.prepared, before, positions, quads, tracks, points);
  return summary;
}

OptimisationSummary optimise_surface(const AllPatches& in) {
  const SurfaceSetup& surface = *in.prepared.surface;
  parallel_for(in.patches.size(), [&](std::size_t i) {
    if (!in.left_out[i]) in.patches[i].inside = places_inside(in.prepared, i, in.patches[i], in.nodes.points);
  });
  std::vector<SurfaceTracks::Patch> patches;
  for (std::size_t i = 0; i < in.patches.size(); ++i)
    if (PatchMesh& patch = in.patches[i]; !in.left_out[i])
      patches.push_back(
          {&surface.domain.patches[i], in.prepared.patches[i].cross.get(), &patch.quads, &patch.inside});
  SurfaceTracks tracks(surface.model, *surface.size, surface.domain, in.nodes, std::move(patches));
  std::vector<Vec3> points = tracks.points();
  const auto summary = optimise<Vec3>(in, points, tracks.quads(), tracks);
  tracks.store(points);
  return summary;
}

/// Optimizes each patch in its flat plane, where the metric is a scalar; its boundary stays.
std::vector<OptimisationSummary> optimise_by_metric(const AllPatches& in) {
  std::vector<OptimisationSummary> summaries(in.patches.size());
  parallel_for(in.patches.size(), [&](std::size_t i) {
    if (in.left_out[i]) return;
    const PatchSetup& prepared = in.prepared.patches[i];
    std::vector<int> own(prepared.boundary.points.size());
    std::iota(own.begin(), own.end(), 0);
    PlanarTracks tracks(prepared.boundary.points, {}, {{&in.patches[i].quads, own, prepared.cross.get()}},
                        *prepared.size);
    std::vector<Vec2> points = tracks.points();
    summaries[i] = optimise_on_tracks(points, tracks.quads(), tracks, optimisation_options(in.options));
    tracks.store(points);
  });
  return summaries;
}

OptimisationSummary optimise_plane(const AllPatches& in) {
  std::vector<Vec2> nodes;
  for (const Vec3& p : in.nodes.points) nodes.push_back({p.x, p.y});
  const std::size_t n_nodes = nodes.size();
  std::vector<PlanarTracks::Patch> patches;
  for (std::size_t i = 0; i < in.patches.size(); ++i) {
    if (in.left_out[i]) continue;
    const PatchSetup& prepared = in.prepared.patches[i];
    patches.push_back({&in.patches[i].quads, prepared.boundary.point_node, prepared.cross.get()});
  }
  PlanarTracks tracks(std::move(nodes), in.prepared.plane.curve_places, std::move(patches),
                      *in.prepared.patches[0].size);
  std::vector<Vec2> points = tracks.points();
  const auto summary = optimise<Vec2>(in, points, tracks.quads(), tracks);
  tracks.store(points);
  for (std::size_t i = 0; i < n_nodes; ++i)
    in.nodes.points[i] = {points[i].x, points[i].y, in.nodes.points[i].z};
  return summary;
}

/// Untangles each patch in its plane. Then all vertices move together, and nodes along their curves.
void optimise_quads(const AllPatches& in, StageLog& log) {
  const Stopwatch watch;
  if (in.prepared.surface && in.prepared.surface->metric) {
    for (const OptimisationSummary& summary : optimise_by_metric(in)) add_summary(log, summary);
  } else {
    OptimisationSummary summary = in.prepared.surface ? optimise_surface(in) : optimise_plane(in);
    summary.seconds = watch.seconds();
    add_summary(log, summary);
  }
  log.add_time("optimisation", watch.time());
}

/// Returns all stages; pointers to them stay valid if more are added.
std::deque<Stage>& stages() {
  static std::deque<Stage> all = {
      insertion_stage('F', "L2 insertion", [](const Options&) { return make_l2_frontal(); }),
      {'D', "L-infinity insertion", PatchForm::kBoundary, PatchForm::kTriangles,
       [](const StageInput& in, PatchMesh& patch, StageLog& log) {
         insert_points(mesh_delquad, *make_linf_delquad(), in, patch, log);
       }},
      {'P', "packing along the cross", PatchForm::kBoundary, PatchForm::kTriangles,
       [](const StageInput& in, PatchMesh& patch, StageLog& log) {
         insert_points(mesh_packing, *make_linf_delquad(), in, patch, log);
       }},
      {'L', "Lp-CVT smoothing", PatchForm::kTriangles, PatchForm::kTriangles, smooth_triangles},
      {'B', "recombination", PatchForm::kTriangles, PatchForm::kQuads, merge_triangles},
      {'G', "greedy recombination", PatchForm::kTriangles, PatchForm::kQuads, merge_and_treat, {}, true},
      {'T', "L-infinity adaptation", PatchForm::kTriangles, PatchForm::kQuads, adapt_and_merge, {}, true},
      // On surfaces run_joint_layouts() follows.
      {'R', "layouts", PatchForm::kQuads, PatchForm::kQuads, lay_out_where_better, {}, false, true},
      {'C', "topological clean-up", PatchForm::kQuads, PatchForm::kQuads, clean_up_quads},
      {'Q', "regularity", PatchForm::kQuads, PatchForm::kQuads, make_quads_regular, {}, false, true},
      {'O', "vertex optimisation", PatchForm::kQuads, PatchForm::kQuads, untangle_quads, optimise_quads},
  };
  return all;
}

std::string form_name(PatchForm form) {
  switch (form) {
    case PatchForm::kBoundary:
      return "a boundary";
    case PatchForm::kTriangles:
      return "triangles";
    case PatchForm::kQuads:
      return "quads";
  }
  return "";
}

std::string known_stages() {
  std::string known;
  for (const Stage& stage : stage_registry())
    known += (known.empty() ? "" : ", ") + std::string(1, stage.letter) + " (" + stage.name + ")";
  return known;
}

/// Returns a suggestion in capitals if they make a pipeline; else an empty text.
std::string capitals_suggestion(const std::string& text) {
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto is_known = [](char letter) {
    return std::ranges::find(stage_registry(), letter, &Stage::letter) != stage_registry().end();
  };
  return std::ranges::all_of(capitals, is_known) ? "; did you mean '" + capitals + "'?" : "";
}

}  // namespace

Stage insertion_stage(char letter, const std::string& name,
                      std::function<std::unique_ptr<PointPlacement>(const Options&)> make_placement) {
  return {letter, name, PatchForm::kBoundary, PatchForm::kTriangles,
          [make = std::move(make_placement)](const StageInput& in, PatchMesh& patch, StageLog& log) {
            const auto placement = make(in.options);
            if (!placement) throw Error("the stage made no placement of points");
            insert_points(mesh_frontal, *placement, in, patch, log);
          }};
}

const std::deque<Stage>& stage_registry() { return stages(); }

void add_stage(Stage stage) {
  if (!stage.run) throw std::invalid_argument(std::string("stage '") + stage.letter + "' has nothing to run");
  if (stage.letter < 'A' || stage.letter > 'Z')
    throw std::invalid_argument(fmt::format("stage '{}': expected a capital from A to Z", stage.letter));
  if (std::ranges::find(stages(), stage.letter, &Stage::letter) != stages().end())
    throw std::invalid_argument(std::string("there is a stage '") + stage.letter + "' already");
  stages().push_back(std::move(stage));
}

bool Pipeline::quads_only() const {
  return result == PatchForm::kQuads && !stages.empty() &&
         std::ranges::none_of(stages, [](const Stage* stage) { return stage->leaves_triangles; });
}

PipelineStart pipeline_start(const Model& model) {
  const auto* file = std::get_if<ModelFile>(&model);
  const bool given = std::holds_alternative<GivenMesh>(model) || (file != nullptr && file->given);
  return given ? PipelineStart::kGivenMesh : PipelineStart::kBoundary;
}

Pipeline parse_pipeline(const std::string& text, PipelineStart start) {
  const std::string label = "pipeline '" + text + "': ";
  if (text.empty()) throw InputError("empty pipeline: expected stages of " + known_stages());
  Pipeline pipeline{text, {}, PatchForm::kBoundary};
  for (const char letter : text) {
    const auto stage = std::ranges::find(stages(), letter, &Stage::letter);
    if (stage == stages().end())
      throw InputError(label + "unknown stage '" + std::string(1, letter) + "'; known: " + known_stages() +
                       capitals_suggestion(text));
    const bool begins = pipeline.stages.empty() && start == PipelineStart::kGivenMesh;
    if (stage->from != pipeline.result && !begins)
      throw InputError(
          label + "'" + letter + "' starts from " + form_name(stage->from) + ", but " +
          (pipeline.stages.empty() ? "a pipeline starts from " : "what stands before it leaves ") +
          form_name(pipeline.result));
    pipeline.stages.push_back(&*stage);
    pipeline.result = stage->to;
  }
  return pipeline;
}

}  // namespace delquad
