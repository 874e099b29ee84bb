#include "mesher/runner.h"
#include "features/layers/add_layers.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <functional>
#include <new>
#include <stdexcept>

#include "algorithms/finish/lift_bad_quads.h"
#include "algorithms/finish/part_twins.h"
#include "algorithms/insertion/frontal_mesher.h"
#include "base/activity.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "delquad/error.h"
#include "features/given/given_domain.h"
#include "features/grids/mapped_grid.h"
#include "features/layers/planar_layers.h"
#include "features/periodic/face_images.h"
#include "features/symmetry/mirror_mesh.h"
#include "features/symmetry/patch_image.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/triangle_sides.h"
#include "mesher/across_cuts.h"
#include "mesher/curved_mesh.h"
#include "mesher/keep_better.h"
#include "mesher/poor_quads.h"
#include "mesher/recombination_options.h"
#include "mesher/repair_options.h"

namespace delquad {
namespace {

long long peak_memory() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024LL * usage.ru_maxrss;
}

const std::vector<Vec2>& points_of(const PatchMesh& patch) {
  return patch.form == PatchForm::kTriangles ? patch.triangles.points : patch.quads.points;
}

/// Mesh node of each point of a patch; nodes are made for the points inside.
std::vector<int> add_points(const std::vector<Vec3>& inside, const PreparedPatch& patch, Mesh& mesh) {
  std::vector<int> node = patch.boundary.point_node;
  for (const Vec3& x : inside) {
    node.push_back(static_cast<int>(mesh.points.size()));
    mesh.points.push_back(x);
  }
  return node;
}

template <std::size_t N>
void add_elements(const std::vector<std::array<int, N>>& elements, const std::vector<int>& node, int region,
                  std::vector<std::array<int, N>>& target, std::vector<int>& target_region) {
  target.reserve(target.size() + elements.size());
  for (std::array<int, N> element : elements) {
    for (int& v : element) v = node[v];
    target.push_back(element);
    target_region.push_back(region);
  }
}

/// Adds the quads around tips of cones, where meshes are still of triangles each as two.
void add_caps(const SurfaceDomain& domain, const std::vector<PatchMesh>& patches,
              const std::vector<char>& left_out, Mesh& mesh) {
  for (const auto& [patch, cap] : domain.caps) {
    const int region = domain.patches[patch].map.face;
    if (left_out[region]) continue;
    for (const auto& [a, b, c, d] : cap.quads) {
      if (patches[patch].form == PatchForm::kTriangles) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        mesh.triangle_region.insert(mesh.triangle_region.end(), 2, region);
      } else {
        mesh.quads.push_back({a, b, c, d});
        mesh.quad_region.push_back(region);
      }
    }
  }
}

/// Takes out lines that are on no element, and points that nothing uses then.
void drop_stray_lines(Mesh& mesh) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::size_t kept = 0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    if (sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).empty()) continue;
    mesh.lines[kept] = mesh.lines[l];
    mesh.line_curve[kept++] = mesh.line_curve[l];
  }
  mesh.lines.resize(kept);
  mesh.line_curve.resize(kept);
  drop_unused_points(mesh);
}

/// max_elements bounds what is inserted, too: a quad mesh has about as many points as quads.
long long most_points(const PreparedProblem& prepared) {
  constexpr long long kPointsPerElement = 4;
  return kPointsPerElement * prepared.max_elements;
}

template <std::size_t N>
bool are_below(const std::vector<std::array<int, N>>& elements, std::size_t n, int least = 0) {
  return std::ranges::all_of(elements, [&](const auto& element) {
    return std::ranges::all_of(element, [&](int i) { return i >= least && i < static_cast<int>(n); });
  });
}

/// Stages from outside may leave anything: what the next ones rely on, as far as they would crash.
void check_stage_result(const Stage& stage, const PatchBoundary& boundary, const PatchMesh& mesh) {
  const auto refuse = [&](const char* what) {
    throw std::runtime_error(fmt::format("stage {} ({}) left {}", stage.letter, stage.name, what));
  };
  if (mesh.form != stage.to) refuse("a mesh of another form than it says");
  if (mesh.form == PatchForm::kBoundary) return;
  const bool of_triangles = mesh.form == PatchForm::kTriangles;
  const std::vector<Vec2>& points = points_of(mesh);
  if ((of_triangles ? mesh.triangles.n_boundary : mesh.quads.n_boundary) !=
          static_cast<int>(boundary.points.size()) ||
      points.size() < boundary.points.size() ||
      !std::equal(boundary.points.begin(), boundary.points.end(), points.begin()))
    refuse("a mesh whose first points are not those of the boundary");
  const TriPatch& tri = mesh.triangles;
  if (of_triangles
          ? !are_below(tri.triangles, points.size())
          : !are_below(mesh.quads.quads, points.size()) || !are_below(mesh.quads.triangles, points.size()))
    refuse("an element with a corner that is no point");
  if (of_triangles &&
      (tri.neighbours.size() != tri.triangles.size() || !are_below(tri.neighbours, tri.triangles.size(), -1)))
    refuse("triangles without neighbours");
}

/// What a word begins from with this stage.
PatchMesh given_to(const Stage& stage, const PreparedProblem& prepared, const PreparedPatch& patch) {
  if (patch.given.points.empty())
    throw InputError(fmt::format("{}: '{}' cannot begin a pipeline here: no mesh is given to begin from",
                                 prepared.where, stage.letter));
  const auto has_quads = [](const PreparedPatch& other) { return !other.given.quads.empty(); };
  PatchMesh start;
  // In space regions may be small, and cuts may part triangles from quads: they stay.
  if (prepared.surface && stage.from == PatchForm::kQuads &&
      std::ranges::any_of(prepared.patches, has_quads)) {
    start.form = PatchForm::kQuads;
    start.quads = patch.given;
  } else {
    start = located(prepared.where, [&] { return start_from(patch.given, stage.from); });
  }
  start.inside = patch.given_inside;
  return start;
}

/// Takes a patch through one stage. Returns why its face has to be left out, naming it; empty: it has not.
std::string run_on_patch(const Stage& stage, const PreparedProblem& prepared, std::size_t i, PatchMesh& mesh,
                         StageLog& log) {
  const PreparedPatch& patch = prepared.patches[i];
  const StageInput input{patch.boundary, *patch.cross, *patch.size, prepared.options, most_points(prepared)};
  const auto run = [&] {
    if (mesh.form != stage.from) {
      mesh = given_to(stage, prepared, patch);
      mesh.inside.clear();
    }
    stage.run(input, mesh, log);
    check_stage_result(stage, patch.boundary, mesh);
  };
  if (!prepared.surface) {
    run();
    return "";
  }
  const std::string title =
      fmt::format("face {}: {}: ", prepared.boundary.regions[patch.region].tag, stage.name);
  try {
    run();
    return "";
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const InputError& error) {
    if (!prepared.keep_going) throw InputError(prepared.where + ": " + title + error.what());
    return title + error.what();
  } catch (const std::exception& error) {
    if (!prepared.keep_going) throw std::runtime_error(prepared.where + ": " + title + error.what());
    return title + error.what();
  }
}

/// Adds the faces of the patches that have a reason to be left out; marks all that are.
std::vector<char> collect_failures(const PreparedProblem& prepared, const std::vector<std::string>& reasons,
                                   RunResult& result) {
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
  if (std::ranges::none_of(prepared.patches, [&](const PreparedPatch& p) { return !left_out[p.region]; }))
    throw InputError("no face can be meshed: " + result.failures.at(0).reason);
  return left_out;
}

/// Of a step that would have taken too long.
Warning stopped_early(const PreparedProblem& prepared, const std::string& step, int face) {
  return {"steps that were stopped before their end", 0,
          fmt::format("{}: {} of face {} was stopped before its end, as it would take too long: quads there "
                      "may be poor; a model without slivers and spikes there, or a smaller size, helps",
                      prepared.name, step, face)};
}

/// `left_out`: by region.
void lift(const PreparedProblem& prepared, MeshingState& state, const std::vector<char>& left_out,
          StageLog& log) {
  if (!prepared.surface) return;
  const Stopwatch watch;
  const DoingStage lifting("lifting");
  std::vector<char> patch_left_out;
  for (const PreparedPatch& patch : prepared.patches)
    patch_left_out.push_back(left_out[patch.region] || (patch.grid && patch.grid_stays) || patch.given_stays);
  LiftingSummary summary =
      lift_bad_quads({prepared, prepared.options, state.patches, patch_left_out, state.nodes});
  summary.seconds = watch.work_seconds();
  if (summary.stopped > 0) state.warnings.push_back(stopped_early(prepared, "lifting", summary.stopped));
  add_summary(log, summary);
  log.add_time("lifting", watch.time());
}

}  // namespace

void require_sound(const std::string& label, const RunResult& result) {
  if (!result.soundness.accepted()) throw UnsoundError(label + ": " + result.soundness.complaint());
}

Mesh assemble(const PreparedProblem& prepared, const std::vector<Vec3>& nodes,
              const std::vector<PatchMesh>& patches, const std::vector<char>& left_out, StageLog* log) {
  const Stopwatch projection;
  const DoingStage projecting("projection");
  std::vector<std::vector<Vec3>> inside(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        if (left_out[prepared.patches[i].region]) return;
        const DoingFace face = doing_patch(prepared, i);
        inside[i] =
            patches[i].inside.empty() ? places_inside(prepared, i, patches[i], nodes) : patches[i].inside;
      },
      [&](std::size_t i) { return static_cast<double>(points_of(patches[i]).size()); });
  Mesh mesh = prepared.boundary;
  mesh.points = nodes;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const PatchMesh& patch = patches[i];
    const int region = prepared.patches[i].region;
    if (left_out[region]) continue;
    const auto node = add_points(inside[i], prepared.patches[i], mesh);
    if (patch.form == PatchForm::kTriangles) {
      add_elements(patch.triangles.triangles, node, region, mesh.triangles, mesh.triangle_region);
    } else {
      add_elements(patch.quads.triangles, node, region, mesh.triangles, mesh.triangle_region);
      add_elements(patch.quads.quads, node, region, mesh.quads, mesh.quad_region);
    }
  }
  if (prepared.surface) {
    const SurfaceDomain& domain = prepared.surface->domain;
    add_caps(domain, patches, left_out, mesh);
    add_face_images(left_out, mesh);
    if (prepared.surface->mirrored) mesh = mirror_mesh(*prepared.surface->mirrored, std::move(mesh));
    if (!domain.caps.empty()) drop_unused_points(mesh);
  }
  if (std::ranges::find(left_out, 1) != left_out.end()) drop_stray_lines(mesh);
  if (log != nullptr) log->add_time("projection", projection.time());
  return mesh;
}

namespace {

/// Area over the square of a mean boundary edge.
double rough_quads(const PatchBoundary& boundary) {
  double double_area = 0, length = 0;
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 a = boundary.points[i], b = boundary.points[j];
    double_area += cross(a, b);
    length += norm(b - a);
  }
  const double edge = length / static_cast<double>(boundary.edges.size());
  return double_area / 2 / (edge * edge);
}

/// Insertion is told how many points it may make.
void check_insertion(const PreparedProblem& prepared, const StageLog& log) {
  const SummaryStep* insertion = log.summaries.find("insertion");
  if (insertion == nullptr) return;
  const SummaryField* termination = insertion->find("termination");
  if (termination != nullptr && termination->value == SummaryValue(name_of(FrontalTermination::kMaxPoints)))
    throw InputError(fmt::format(
        "{}: insertion stopped at {} points, the most that {} elements (max-elements) allow", prepared.where,
        log.summaries.get<long long>("insertion", "inserted"), prepared.max_elements));
}

}  // namespace

void measure(const PreparedProblem& prepared, const std::vector<char>& left_out, RunResult& result) {
  const DoingStage measuring("report");
  TimeSpent metrics_time, report_time, soundness_time;
  // A place that is not finite is nowhere near a surface.
  const bool has_report = prepared.surface && has_finite_points(result.mesh);
  const Stopwatch sorting;
  const std::vector<HalfEdge> sides = sorted_half_edges(result.mesh);
  const TimeSpent sorted = sorting.time();
  const std::function<void()> parts[] = {
      [&] {
        const Stopwatch watch;
        result.metrics = evaluate_metrics(result.mesh, prepared.size.get(), prepared.given_size.get(),
                                          prepared.options, sides, quads_in_layers(prepared, result.mesh));
        metrics_time = watch.time();
      },
      [&] {
        const Stopwatch watch;
        if (has_report) {
          const PreparedSurface& surface = *prepared.surface;
          result.surface =
              report_surface(surface.whole(), surface.all_cuts(),
                             surface.mirrored ? with_images(*surface.mirrored, left_out) : left_out,
                             result.mesh, sides, surface.mirrored ? prepared.size.get() : surface.size.get());
          report_time = watch.time();
        }
        const Stopwatch checking;
        result.soundness =
            check_soundness(prepared, result.mesh, result.surface ? &*result.surface : nullptr, sides);
        soundness_time = checking.time();
      }};
  parallel_for(std::size(parts), [&](std::size_t i) { parts[i](); });
  result.log.add_time("metrics", sorted + metrics_time);
  if (has_report) result.log.add_time("surface report", report_time);
  result.log.add_time("soundness", soundness_time);
}

namespace {

/// Of a curved mesh, after its vertices moved.
void measure_straight_form(const PreparedProblem& prepared, const std::vector<char>& left_out,
                           RunResult& result) {
  RunResult straight;
  straight.mesh = straight_form(result.mesh);
  measure(prepared, left_out, straight);
  result.log.add(straight.log);
  result.metrics = std::move(straight.metrics);
  result.surface = std::move(straight.surface);
  for (std::string& reason : straight.soundness.reasons)
    result.soundness.reasons.push_back(std::move(reason));
  result.soundness.places.insert(result.soundness.places.end(), straight.soundness.places.begin(),
                                 straight.soundness.places.end());
}

}  // namespace

void put_back_entities(const GivenEntities& given, Mesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const int curve = given.curve_of[mesh.line_curve[l]];
    if (curve < 0) continue;
    mesh.lines[kept] = mesh.lines[l];
    mesh.line_curve[kept++] = curve;
  }
  mesh.lines.resize(kept);
  mesh.line_curve.resize(kept);
  for (auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (int& region : *regions) region = given.region_of[region];
  mesh.curves = given.curves;
  mesh.regions = given.regions;
}

namespace {

void count_grids(const PreparedProblem& prepared, StageLog& log) {
  long long faces = 0, asked = 0, quads = 0;
  for (const PreparedPatch& patch : prepared.patches) {
    if (!patch.grid) continue;
    ++faces;
    asked += patch.grid_stays;
    quads += static_cast<long long>(patch.grid->quads.size());
  }
  if (faces > 0) log.summaries.add("grids", {{"faces", faces}, {"asked", asked}, {"quads", quads}});
}

}  // namespace

MeshingState begin_meshing(const PreparedProblem& prepared) {
  MeshingState state;
  state.patches.resize(prepared.patches.size());
  state.reasons.resize(prepared.patches.size());
  if (prepared.surface) state.nodes = prepared.surface->domain.nodes;
  state.nodes.points = prepared.boundary.points;
  if (prepared.layers) add_summary(state.log, prepared.layers->count);
  count_grids(prepared, state.log);
  return state;
}

namespace {

/// Of each patch; tells what was stopped.
void add_logs(const PreparedProblem& prepared, const std::vector<StageLog>& logs, MeshingState& state) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (const char* step : {"treatment", "cleanup"})
      if (logs[i].summaries.has(step) && logs[i].summaries.number(step, "stopped") > 0)
        state.warnings.push_back(
            stopped_early(prepared, step, prepared.boundary.regions[prepared.patches[i].region].tag));
    state.log.add(logs[i]);
  }
}

}  // namespace

void run_stage(const Stage& stage, const PreparedProblem& prepared, MeshingState& state) {
  const Stopwatch watch;
  const DoingStage running(stage.name.c_str());
  if (stage.from == PatchForm::kQuads) state.of_quads.push_back(&stage);
  std::vector<PatchMesh>& patches = state.patches;
  if (stage.from == PatchForm::kQuads && patches[0].form == PatchForm::kBoundary)
    for (std::size_t i = 0; i < patches.size(); ++i)
      state.given.push_back(given_to(stage, prepared, prepared.patches[i]));
  std::vector<StageLog> logs(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        std::string& reason = state.reasons[i];
        const DoingFace face = doing_patch(prepared, i);
        patches[i].inside.clear();
        if (prepared.patches[i].image) return;
        if (prepared.patches[i].given_stays) {
          if (patches[i].form != stage.to) patches[i] = given_to(stage, prepared, prepared.patches[i]);
          return;
        }
        if (const auto& grid = prepared.patches[i].grid) {
          if (patches[i].form != stage.to) patches[i] = grid_as(stage.to, *grid);
          return;
        }
        if (reason.empty()) reason = run_on_patch(stage, prepared, i, patches[i], logs[i]);
      },
      [&](std::size_t i) {
        return patches[i].form == PatchForm::kBoundary ? rough_quads(prepared.patches[i].boundary)
                                                       : static_cast<double>(points_of(patches[i]).size());
      });
  add_logs(prepared, logs, state);
  check_insertion(prepared, state.log);
  std::vector<char> left_out, held;  // what stays when points of quads move: fewer grids
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const PreparedPatch& patch = prepared.patches[i];
    left_out.push_back(!state.reasons[i].empty() || patch.grid || patch.image || patch.given_stays);
    held.push_back(left_out.back() && (!patch.grid || patch.grid_stays || patch.image));
  }
  const AllPatches all{prepared, prepared.options, patches, left_out, state.nodes};
  if (prepared.surface && repair_options(prepared.options).part_twins) {
    const Stopwatch parting;
    PartingSummary parted = part_twins(all);
    parted.seconds = parting.work_seconds();
    add_summary(state.log, parted);
    state.log.add_time("parting", parting.time());
  }
  if (stage.finish)
    stage.finish({prepared, prepared.options, patches, stage.from == PatchForm::kQuads ? held : left_out,
                  state.nodes, !state.given.empty()},
                 state.log);
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (const auto& image = prepared.patches[i].image) {
      patches[i] = image_of(patches[image->master], prepared.patches[i].boundary, *image);
      move_image_nodes(prepared, *image, state.nodes.points);
      state.reasons[i] = state.reasons[image->master];
    }
  state.seconds += watch.seconds();
}

Mesh put_together(const PreparedProblem& prepared, const std::vector<char>& left_out, MeshingState& state) {
  if (recombination_options(prepared.options).treatment == Treatment::kPaper &&
      repair_options(prepared.options).lift_bad_quads)
    lift(prepared, state, left_out, state.log);
  return assemble(prepared, state.nodes.points, state.patches, left_out, &state.log);
}

RunResult finish_meshing(const PreparedProblem& prepared, const std::string& label, MeshingState state) {
  const Stopwatch watch;
  RunResult result;
  const std::vector<char> left_out = collect_failures(prepared, state.reasons, result);
  const std::vector<PatchMesh> given = std::move(state.given);
  const std::vector<const Stage*> of_quads = state.of_quads;
  result.mesh = put_together(prepared, left_out, state);
  result.warnings = std::move(state.warnings);
  result.log = std::move(state.log);
  state.patches.clear();
  const int rings = part_flat_corners(prepared, state.nodes, result.mesh);
  result.seconds = state.seconds + watch.seconds();
  measure(prepared, left_out, result);
  // A mesh that is not sound is made anew, see refine_unsound(): until then these take time for nothing.
  if (are_cuts_in_the_way(prepared, of_quads) && (result.soundness.sound() || prepared.given_entities))
    run_across_cuts(prepared, of_quads, left_out, result);
  if (!given.empty()) keep_better(prepared, label, given, of_quads, left_out, result);
  if (curve_mesh(prepared, state.nodes, rings, result)) measure_straight_form(prepared, left_out, result);
  result.peak_memory = peak_memory();
  judge_quads(prepared, label, result);
  if (prepared.given_entities) put_back_entities(*prepared.given_entities, result.mesh);
  return result;
}

RunResult run_word(const PreparedProblem& prepared, const Word& word,
                   const std::function<void(const std::string& stage)>& begins) {
  MeshingState state = begin_meshing(prepared);
  for (const Stage* stage : word.stages) {
    if (begins) begins(stage->name);
    run_stage(*stage, prepared, state);
  }
  if (begins) begins("metrics");
  return finish_meshing(prepared, prepared.name + " " + word.text, std::move(state));
}

}  // namespace delquad
