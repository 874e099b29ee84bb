// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/finish_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "algorithms/regularity/regularity.h"
#include "delquad/error.h"
#include "features/given/given_worst.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/nearest_on_regions.h"
#include "metrics/judgement/poor_quads.h"

namespace delquad {
namespace {

constexpr double kNoFeatures = 180;
/// Factors for the price of an irregular vertex with other cuts, since few are left and far apart. The second
/// factor is tried if the first one spoils too much.
constexpr std::array kPriceFactors = {8.0, 4.0};
constexpr double kHighestPrice = 100;
/// A worst eta below this makes a third run worthwhile.
constexpr double kGoodEta = 0.6;

using NodePlaces = std::set<std::array<double, 3>>;
using Stages = std::vector<const Stage*>;

/// Projects to the faces of a model: the true faces, or the given facets.
class FacesOfModel final : public SurfaceProjector {
 public:
  /// `face_of` has the model's face for each face to project to.
  FacesOfModel(const SurfaceModel& model, std::vector<int> face_of)
      : true_faces_(model.projector), face_of_(std::move(face_of)) {
    if (!true_faces_) facets_.emplace(model.fine);
  }
  Vec3 to_face(int face, const Vec3& x) const override {
    return true_faces_ ? true_faces_->to_face(face_of_[face], x) : facets_->place(face_of_[face], x);
  }
  /// Returns x, since nodes on curves stay.
  Vec3 to_curve(int, const Vec3& x) const override { return x; }

 private:
  std::shared_ptr<const SurfaceProjector> true_faces_;
  std::optional<NearestOnRegions> facets_;
  std::vector<int> face_of_;
};

/// A mesh without lines on cuts, and its nodes that could only move along cuts.
struct UncutMesh {
  Mesh mesh;
  NodePlaces on_cuts;
};

/// Removes the lines of curves that are cuts.
UncutMesh without_cuts(Mesh mesh, const std::vector<char>& is_cut) {
  NodePlaces on_cuts;
  keep_lines(mesh, [&](std::size_t l) {
    if (!is_cut[mesh.line_curve[l]]) return true;
    for (const int v : mesh.lines[l]) on_cuts.insert({mesh.points[v].x, mesh.points[v].y, mesh.points[v].z});
    return false;
  });
  return {std::move(mesh), std::move(on_cuts)};
}

UncutMesh without_cuts(const SurfaceSetup& surface, Mesh mesh) {
  std::vector<char> is_cut(mesh.curves.size(), 0);
  for (const SurfaceCut& cut : surface.cuts) is_cut[cut.curve] = 1;
  return without_cuts(std::move(mesh), is_cut);
}

/// Returns for each region whether its mesh can be repeated across its cuts. This excludes symmetric and
/// periodic surfaces, whose sides must stay images of each other. It also excludes regions with requested
/// grids, and all regions if elements will be curved.
std::vector<char> regions_across_cuts(const MeshingSetup& prepared) {
  std::vector<char> regions(prepared.boundary.regions.size(), 0);
  if (prepared.surface->mirrored || prepared.settings.order > 1 || !prepared.boundary.periodic.empty() ||
      !prepared.boundary.periodic_faces.empty())
    return regions;
  for (const SurfaceCut& cut : prepared.surface->cuts) regions[cut.face] = 1;
  for (const PatchSetup& patch : prepared.patches)
    if (patch.grid && patch.grid_stays) regions[patch.region] = 0;
  return regions;
}

/// Returns `start` with other cuts. Moved nodes, in the `regions`, lie on the surface, or on the first given
/// facets. Nodes on curves stay. Throws InputError if that is impossible.
MeshingSetup with_other_cuts(const MeshingSetup& prepared, const std::vector<char>& regions,
                             const UncutMesh& start) {
  GivenSurface given = make_given_surface({start.mesh, prepared.settings.name}, kNoFeatures);
  for (const Vec3& p : given.model.fine.points)
    given.avoided.push_back(start.on_cuts.contains({p.x, p.y, p.z}) ? 1 : 0);
  given.model.projector = std::make_shared<FacesOfModel>(prepared.surface->model, given.given_region);
  MeshProblem problem;
  problem.name = prepared.settings.name;
  problem.where = prepared.settings.where;
  problem.max_elements = prepared.settings.max_elements;
  problem.criteria = prepared.settings.criteria;
  MeshingSetup again = prepare_given_surface(problem, std::move(given), start.mesh, prepared.size.field);
  again.given_worst = prepared.given_worst;
  again.size.asked = prepared.size.asked, again.size.curved = prepared.size.curved;
  for (PatchSetup& patch : again.patches)
    patch.given_stays = regions[again.surface->given->region_of[patch.region]] == 0;
  return again;
}

/// Runs the stages on the problem with other cuts. If the mesh `is_given`, stages keep it where it would
/// become worse.
UncutMesh run_stages(MeshingSetup& again, const Stages& stages, const Options& options, bool is_given) {
  again.settings.options = options;
  again.settings.options.set("repair.keep_given", is_given);
  PipelineState state = begin_meshing(again);
  for (const Stage* stage : stages) run_stage(*stage, again, state);
  const std::vector<char> none(again.boundary.regions.size(), 0);
  FinishContext on{state.now(again), state, none};
  UncutMesh made = without_cuts(*again.surface, finish_patches(on));
  put_back_entities(*again.surface->given, made.mesh);
  return made;
}

/// Returns the stages that move nodes of curves, all patches together.
Stages moving_stages(const Stages& stages) {
  Stages found;
  std::ranges::copy_if(stages, std::back_inserter(found),
                       [](const Stage* stage) { return bool(stage->finish); });
  return found;
}

/// Returns whether the result is taken. For a given mesh it must be better as a whole, else it must have
/// fewer irregular vertices.
bool should_take(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before) {
  if (!after.soundness.sound() || !before.soundness.sound()) return after.soundness.sound();
  if (prepared.surface->given) return is_better(prepared, after, before);
  return is_more_regular(prepared, after, before) && keeps_worst_eta(kFloorEta, after, before);
}

/// Returns the options for cavities in the second run.
Options with_higher_price(const Options& options, double factor) {
  Options more = options;
  more.set("regularity.tolerance", std::min(factor * options.number("regularity.tolerance"), kHighestPrice));
  more.set("regularity.quads", std::max(options.integer("regularity.quads"), kFarQuads));
  return more;
}

/// Meshes `again`, the problem with other cuts.
MeshResult mesh_across_cuts(const FinishContext& f, MeshingSetup& again, const Options& options,
                            const std::vector<char>& regions) {
  const MeshingSetup& prepared = f.prepared;
  const bool is_given =
      prepared.surface->given.has_value() && repair_options(prepared.settings.options).keep_given;
  UncutMesh made = run_stages(again, f.state.of_quads, options, is_given);
  MeshResult after;
  after.mesh = made.mesh;
  measure(prepared, f.left_out, after);
  const Stages moving = moving_stages(f.state.of_quads);
  if (prepared.surface->given || moving.empty() || !is_more_regular(prepared, after, f.result) ||
      keeps_worst_eta(kGoodEta, after, f.result))
    return after;
  // Nodes on these cuts could only move along them.
  MeshingSetup third = with_other_cuts(prepared, regions, made);
  made = run_stages(third, moving, options, is_given);
  after.mesh = std::move(made.mesh);
  measure(prepared, f.left_out, after);
  return after;
}

/// Takes the mesh with other cuts if it is better. Returns whether it is.
bool take_across_cuts(FinishContext& on, MeshingSetup& again, const Options& options,
                      const std::vector<char>& regions) {
  MeshResult after = mesh_across_cuts(on, again, options, regions);
  if (!should_take(on.prepared, after, on.result)) return false;
  take_mesh(std::move(after), on.result);
  return true;
}

}  // namespace

bool cuts_obstruct(const MeshingSetup& prepared, const Stages& of_quads) {
  if (!prepared.surface || prepared.surface->all_cuts().empty()) return false;
  return prepared.surface->given ? !of_quads.empty() : std::ranges::any_of(of_quads, &Stage::fills_cavities);
}

void run_across_cuts(FinishContext& on) {
  const MeshingSetup& prepared = on.prepared;
  const std::vector<char> regions = regions_across_cuts(prepared);
  const auto irregular = [&] { return static_cast<long long>(on.result.metrics.values.at("n_irregular")); };
  const long long before = irregular();
  long long faces = on.result.failures.empty() ? std::ranges::count(regions, 1) : 0;  // with stages
  bool is_taken = false;
  if (faces > 0) try {
      MeshingSetup again =
          with_other_cuts(prepared, regions, without_cuts(*prepared.surface, on.result.mesh));
      if (prepared.surface->given) is_taken = take_across_cuts(on, again, prepared.settings.options, regions);
      for (const double factor : kPriceFactors)
        if (!prepared.surface->given && !is_taken)
          is_taken =
              take_across_cuts(on, again, with_higher_price(prepared.settings.options, factor), regions);
    } catch (const InputError&) {
      faces = 0;  // the former mesh stays
    }
  on.result.log.summaries.add("across_cuts", {{"faces", faces},
                                              {"taken", static_cast<long long>(is_taken)},
                                              {"irregular_before", before},
                                              {"irregular_after", irregular()}});
}

namespace {

/// Least difference that counts, as a part of the value.
constexpr double kChange = 1e-9;
/// Tau, in percent, at which edges are near enough to their size.
constexpr double kGoodTau = 91;

double value(const MeshResult& run, const char* key) { return run.metrics.values.at(key); }

/// Returns whether a measure is at least `good`, or as large as before.
bool is_kept(const char* key, double good, const MeshResult& after, const MeshResult& before) {
  constexpr double kRounding = 1e-9;
  return value(after, key) > std::min(good, value(before, key)) - kRounding;
}

double score(const MeshResult& run) {
  return value(run, "eta_mean") + value(run, "eta_worst") + value(run, "d4") / 100;
}

}  // namespace

bool is_worse(const MeshResult& after, const MeshResult& before) {
  if (before.soundness.sound() && !after.soundness.sound()) return true;
  if (degradation_of(after, before).sum() > 0) return true;
  if (after.soundness.sound() && !before.soundness.sound()) return false;
  bool worse = false;
  for (const char* key : {"eta_mean", "eta_worst", "d4"}) {
    const double was = value(before, key), is = value(after, key);
    if (!(std::abs(is - was) > kChange * std::abs(was))) continue;  // or not a number: no vertex lies inside
    if (is > was) return false;
    worse = true;
  }
  return worse;
}

bool is_better(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before) {
  const double is = failing_part(prepared, after.mesh), was = failing_part(prepared, before.mesh);
  return (is == was ? score(after) > score(before) : is < was) && !is_worse(after, before);
}

bool is_more_regular(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before) {
  return failing_part(prepared, after.mesh) <= failing_part(prepared, before.mesh) &&
         value(after, "n_irregular") < value(before, "n_irregular") &&
         is_kept("tau", kGoodTau, after, before);
}

bool keeps_worst_eta(double eta, const MeshResult& after, const MeshResult& before) {
  return is_kept("eta_worst", eta, after, before);
}

void take_mesh(MeshResult&& from, MeshResult& result) {
  result.mesh = std::move(from.mesh);
  result.metrics = std::move(from.metrics);
  result.soundness = std::move(from.soundness);
  result.surface = std::move(from.surface);
}

}  // namespace delquad
