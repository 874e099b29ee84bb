// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/box.h"
#include "base/budget.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/metric/metric_plane.h"
#include "features/symmetry/mirrored_surface.h"
#include "mesher/finish_steps.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/soundness.h"

namespace delquad {
namespace {

constexpr const char* kRefining = "refine_unsound";  // in records
/// Most rounds of meshing, and most rounds in a row without fewer unsound places.
constexpr int kMostRounds = 8, kMostIdle = 2;
/// First round in which sharp edges in the spots become features. If small parts were ignored, they do so
/// from the first round on.
constexpr int kFirstWithFeatures = 4;
/// Factor of the size at an unsound place, and radius around it in the new sizes.
constexpr double kPart = 0.5, kReach = 3;
/// Budget of work_on() for all meshes: by the quads, up to some 30 seconds, or a multiple of a large mesh.
/// Other tries may take a third more, if one of them is likely to suffice. The last mesh may exceed the rest
/// by as much.
constexpr long long kLeastWork = 40'000, kWorkPerQuad = 40, kUsualWork = 150'000, kMostTimes = 4;
/// Work that takes as long as a quad: tried places of lifting (LiftingSummary::cost), steps of curves, looks
/// of stages, triangles of maps.
constexpr long long kCostPerQuad = 300, kStepsPerQuad = 7500, kLooksPerQuad = 300, kTrianglesPerQuad = 10;
/// Limit of spots; more of them would cover the whole model.
constexpr std::size_t kMostSpots = 1000;

/// Parts narrower than this part of the size have no room for an edge, and are left out at last.
constexpr double kSmall = 0.1;

/// Distance, in sizes, within which a place near an image counts for its master, too.
constexpr double kBeside = 3;

/// Returns the places in master faces whose images are at these places.
std::vector<Vec3> places_of_masters(const MeshingSetup& prepared, const std::vector<Place>& places) {
  std::vector<Vec3> found;
  for (const PeriodicFaces& pair : prepared.boundary.periodic_faces) {
    const Mesh& fine = prepared.surface->model.fine;
    Box<Vec3> box;
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      if (fine.triangle_region[t] == pair.face)
        for (const int v : fine.triangles[t]) box.add(fine.points[v]);
    int hint = -1;
    for (const Place& place : places)
      if (std::sqrt(box.distance2(place.at)) <= kBeside * prepared.size.field->at(place.at, hint))
        found.push_back(pair.motion.inverse()(place.at));
  }
  return found;
}

/// Adds a ball around each unsound place, except places inside of another new ball. The old balls tell
/// the size of places far from a surface, too, where the field does not know it.
void add_spots(const MeshingSetup& prepared, const Soundness& soundness, std::vector<SizeBall>& spots) {
  const std::size_t first_new = spots.size();
  int hint = -1;
  const auto add = [&](const Vec3& place) {
    const Vec3 at = prepared.metric_plane ? prepared.metric_plane->to_flat(place) : place;
    const bool is_known = std::any_of(spots.begin() + static_cast<std::ptrdiff_t>(first_new), spots.end(),
                                      [&](const SizeBall& s) { return norm(s.at - at) < s.size; });
    if (is_known || spots.size() == kMostSpots) return;
    double size = prepared.size.field->at(at, hint);
    for (std::size_t i = 0; i < first_new; ++i)
      if (norm(spots[i].at - at) < spots[i].reach) size = std::min(size, spots[i].size);
    size *= kPart;
    if (prepared.surface && prepared.surface->mirrored) {
      // Adds all images, so that details kept for a part are kept for the whole.
      const SymmetryPlanes& planes = prepared.surface->mirrored->planes;
      const Vec3 x = planes.fold(at);
      for (int mask = 0; mask < 1 << planes.count(); ++mask)
        spots.push_back({planes.reflect_all(mask, x), kReach * size, size});
      return;
    }
    spots.push_back({at, kReach * size, size});
  };
  for (const Place& place : soundness.places) add(place.at);
  for (const Vec3& at : places_of_masters(prepared, soundness.places)) add(at);
}

Warning warning_of(const MeshingSetup& prepared, const std::vector<SizeBall>& spots) {
  const SizeBall& least = *std::ranges::min_element(spots, {}, &SizeBall::size);
  return fmt::format(
      "{}: around {} place(s) the size is smaller, as the mesh would not be sound: down to {:.3g} at {} "
      "[changed-to-be-sound]",
      prepared.settings.name, spots.size(), least.size,
      show_point(prepared.metric_plane ? prepared.metric_plane->to_plane(least.at) : least.at));
}

/// Returns the number of unsound places, of which a hundred are listed for each reason.
std::size_t unsound_places(const MeshResult& result) { return result.soundness.places.size(); }

Warning warning_of_end(const MeshResult& result, const MeshingSetup& prepared, long long rounds,
                       const char* why) {
  return fmt::format(
      "{}: smaller sizes around places where the mesh is not sound were tried {} time(s), and {}: {} or more "
      "such places are left. Remove slivers and spikes there from the model [unsound-mesh]",
      prepared.settings.name, rounds, why, unsound_places(result));
}

void make_finer(const PrepareWithHints& prepare_with_hints, const Pipeline& pipeline, Budget& work,
                MeshingSetup& prepared, MeshResult& result) {
  // Given lines keep their nodes.
  const bool can_be_finer =
      (prepared.surface && !prepared.surface->given) || !prepared.plane.curve_places.empty();
  if (result.soundness.sound() || !can_be_finer || !repair_options(prepared.settings.options).refine_unsound)
    return;
  const bool ignores_small = prepared.surface && prepared.surface->model.before;
  RetryHints hints = no_hints(prepared);
  add_spots(prepared, result.soundness, hints.spots);
  if (hints.spots.empty()) return;
  StageLog lost;  // times of all meshes except the best
  double seconds = result.seconds;
  long long rounds = 0, idle = 0;  // rounds in all, and since the best mesh
  long long last = work_on(prepared, result);
  const char* why = "that no longer helped";
  try {
    while (!result.soundness.sound()) {
      if (rounds == kMostRounds || 2 * work.left() < last) {
        why = "more would take too long";
        break;
      }
      if (idle == kMostIdle && (hints.keep_features || (hints.cad && !ignores_small))) break;
      if (idle == kMostIdle) idle = 0, hints.keep_features = true;
      if (++rounds >= kFirstWithFeatures || ignores_small) hints.keep_features = true;
      const std::vector<SizeBall> spots = hints.spots;
      MeshingSetup finer = prepare_with_hints(hints);
      MeshResult run = run_pipeline(finer, pipeline);
      seconds += run.seconds;
      last = work_on(finer, run);
      work.spend(last);
      add_spots(finer, run.soundness, hints.spots);
      const bool is_better =
          run.soundness.sound() || (unsound_places(run) > 0 && unsound_places(run) < unsound_places(result));
      idle = is_better ? 0 : idle + 1;
      if (is_better) {
        run.log.summaries.add(kRefining,
                              {{"rounds", rounds}, {"spots", static_cast<long long>(spots.size())}});
        run.warnings.push_back(warning_of(finer, spots));
        std::swap(prepared, finer);
        std::swap(result, run);
      }
      add_times(finer.times, lost);
      add_times(run.log.times, lost);
      if (hints.spots.size() == spots.size()) break;
    }
  } catch (const InputError&) {
    // Too many elements or an impossible boundary: the former mesh stays.
  }
  result.seconds = seconds;
  add_times(lost.times, result.log);
  double failed_seconds = 0;
  for (const auto& [step, time] : lost.times) failed_seconds += time.seconds;
  note_seconds(kRefining, failed_seconds, result.log.summaries);
  if (!result.soundness.sound()) result.warnings.push_back(warning_of_end(result, prepared, rounds, why));
}

/// Meshes without details that are small beside the size, and takes the mesh if it is sound.
void leave_out_small(const PrepareWithHints& prepare_with_hints, const Pipeline& pipeline, Budget& work,
                     MeshingSetup& prepared, MeshResult& result) {
  const RepairOptions options = repair_options(prepared.settings.options);
  if (!prepared.unselected.empty() || !options.refine_unsound || !options.ignore_small || !prepared.surface ||
      prepared.surface->given || prepared.surface->model.before || result.soundness.places.empty())
    return;
  double least = std::numeric_limits<double>::infinity();
  int hint = -1;
  for (const Place& place : result.soundness.places)
    least = std::min(least, requested_size(prepared).at(place.at, hint));
  const auto anew = [&](RetryHints hints) {
    hints.ignore_below = kSmall * least;
    return prepare_with_hints(hints);
  };
  try {
    MeshingSetup other = anew(no_hints(prepared));
    MeshResult run = run_pipeline(other, pipeline);
    work.spend(work_on(other, run));
    make_finer(anew, pipeline, work, other, run);
    if (run.soundness.sound()) {
      run.warnings.emplace_back(
          fmt::format("{}: parts narrower than {:.3g}, a tenth of the size, are left out, as the mesh would "
                      "not be sound: {}. --set repair.ignore_small=false keeps them [changed-to-be-sound]",
                      prepared.settings.name, kSmall * least, result.soundness.text()));
      run.log.summaries.add(kRefining, {{"ignored_below", kSmall * least}});
      std::swap(prepared, other);
      std::swap(result, run);
    }
    result.seconds += run.seconds;
    add_times(other.times, result.log);
    add_times(run.log.times, result.log);
  } catch (const InputError&) {
    // Nothing is left, or it cannot be meshed: the former mesh stays.
  }
}

/// A last try, which may be sound by chance. It scales all sizes, runs only the stages that make quads, or
/// gives a triangulation another feature angle (0: as in the problem).
struct Fallback {
  double size_part;
  bool makes_quads_only;
  double feature_angle = 0;
};
constexpr std::size_t kMostByChance = 20;  // most unsound places for such a try
constexpr std::array kFallbacks = {Fallback{0.8, false}, Fallback{1, true}, Fallback{0.5, false},
                                   Fallback{1, false, 60}, Fallback{1, false, 25}};

/// Returns the change for a warning, such as "by the stages DB alone".
std::string fallback_text(const Fallback& last, const Pipeline& first) {
  if (last.makes_quads_only) return fmt::format("by the stages {} alone", first.text);
  if (last.feature_angle > 0) return fmt::format("with a feature angle of {:g} degrees", last.feature_angle);
  return fmt::format("with all sizes times {:g}", last.size_part);
}

/// Returns the stages of a pipeline up to its first quads.
Pipeline pipeline_until_quads(const Pipeline& pipeline) {
  Pipeline first{"", {}, PatchForm::kQuads};
  for (const Stage* stage : pipeline.stages) {
    first.text += stage->letter;
    first.stages.push_back(stage);
    if (stage->to == PatchForm::kQuads) break;
  }
  return first;
}

/// Takes the first of the last tries whose mesh is sound.
void take_fallback(const PrepareWithHints& prepare_with_hints, const Pipeline& pipeline, Budget& work,
                   MeshingSetup& prepared, MeshResult& result) {
  if (!repair_options(prepared.settings.options).refine_unsound || !prepared.surface ||
      prepared.surface->given || prepared.surface->model.before || unsound_places(result) > kMostByChance)
    return;
  const double once = static_cast<double>(result.mesh.quads.size());
  const Pipeline first = pipeline_until_quads(pipeline);
  for (const Fallback& last : kFallbacks) {
    const double part = last.size_part;
    if (last.makes_quads_only && first.text == pipeline.text) continue;
    if (!last.makes_quads_only && !prepared.unselected.empty()) continue;  // nodes on curves stay
    if (last.feature_angle > 0 && prepared.surface->cad) continue;
    if (once / (part * part) > static_cast<double>(work.left())) continue;
    try {
      RetryHints hints = no_hints(prepared);
      hints.size_part = part;
      hints.feature_angle = last.feature_angle;
      MeshingSetup other = prepare_with_hints(hints);
      MeshResult run = run_pipeline(other, last.makes_quads_only ? first : pipeline);
      work.spend(work_on(other, run));
      add_times(other.times, result.log);
      add_times(run.log.times, result.log);
      result.seconds += run.seconds;
      if (!run.soundness.sound()) continue;
      run.warnings.emplace_back(fmt::format(
          "{}: the mesh is made {}, as it would not be sound: {}; --set repair.refine_unsound=false does not "
          "try this [changed-to-be-sound]",
          prepared.settings.name, fallback_text(last, first), result.soundness.text()));
      if (last.feature_angle > 0)
        run.log.summaries.add(kRefining, {{"feature_angle", last.feature_angle}});
      else
        run.log.summaries.add(kRefining, {{"size_part", part}});
      run.log.times = std::move(result.log.times);
      run.seconds = result.seconds;
      std::swap(prepared, other);
      result = std::move(run);
      return;
    } catch (const InputError&) {
      // Too many elements, an impossible boundary, or a feature angle that the problem sets.
    }
  }
}

/// Meshes without the faces where the mesh is unsound, as long as others remain.
void leave_out_unsound(const Pipeline& pipeline, MeshingSetup& prepared, MeshResult& result) {
  if (!prepared.settings.keep_going || !prepared.surface || prepared.surface->mirrored ||
      prepared.surface->given)
    return;
  const std::vector<FaceFailure> before = prepared.failures;
  double seconds = result.seconds;
  MeshResult run = result;
  try {
    while (!run.soundness.sound()) {
      const std::size_t n_known = prepared.failures.size();
      for (const Place& place : run.soundness.places)
        if (place.face >= 0 &&
            std::ranges::find(prepared.failures, place.face, &FaceFailure::face) == prepared.failures.end())
          prepared.failures.push_back(
              {place.face, fmt::format("the mesh of {} is not sound", show_place(run.mesh, place))});
      if (prepared.failures.size() == n_known) break;
      run = run_pipeline(prepared, pipeline);
      seconds += run.seconds;
    }
  } catch (const InputError&) {
    // Nothing is left.
  }
  if (run.soundness.sound())
    result = std::move(run);
  else
    prepared.failures = before;
  result.seconds = seconds;
}

/// The pipeline without layouts, whose gain is not worth an unsound mesh.
Pipeline without_layouts(const Pipeline& pipeline) {
  Pipeline other{"", {}, pipeline.result};
  for (const Stage* stage : pipeline.stages) {
    if (stage->letter == 'R') continue;
    other.text += stage->letter;
    other.stages.push_back(stage);
  }
  return other;
}

/// Meshes without layouts where these changed an unsound mesh.
void undo_layouts(const Pipeline& plain, Budget& work, const MeshingSetup& prepared, MeshResult& result) {
  const Summaries& summaries = result.log.summaries;
  if (!repair_options(prepared.settings.options).refine_unsound || !summaries.has("layouts_together") ||
      summaries.number("layouts_together", "accepted") == 0)
    return;
  MeshResult run = run_pipeline(prepared, plain);
  work.spend(work_on(prepared, run));
  run.seconds += result.seconds;
  add_times(result.log.times, run.log);
  run.log.summaries.add(kRefining, {{"without_layouts", 1LL}});
  result = std::move(run);
}

}  // namespace

long long work_on(const MeshingSetup& prepared, const MeshResult& result) {
  double looks = 0;
  for (const char* step : {"treatment", "cleanup", "regularity"})
    if (result.log.summaries.has(step)) looks += result.log.summaries.number(step, "looks");
  long long work = static_cast<long long>(result.mesh.quads.size()) + result.lifting_cost / kCostPerQuad +
                   static_cast<long long>(looks) / kLooksPerQuad;
  if (const auto& surface = prepared.surface)
    work += surface->domain.steps / kStepsPerQuad +
            static_cast<long long>(surface->model.fine.triangles.size()) / kTrianglesPerQuad;
  return work;
}

void refine_unsound(const PrepareWithHints& prepare_with_hints, const Pipeline& pipeline,
                    MeshingSetup& prepared, MeshResult& result) {
  const auto quads = static_cast<long long>(result.mesh.quads.size());
  const long long once = work_on(prepared, result),
                  most =
                      std::max(std::min(kLeastWork + kWorkPerQuad * quads, kUsualWork), kMostTimes * quads);
  Budget finer(most - once), others(most / 3);
  const Pipeline plain = without_layouts(pipeline);
  undo_layouts(plain, finer, prepared, result);
  make_finer(prepare_with_hints, plain, finer, prepared, result);
  others.spend(std::max(-finer.left(), 0LL));
  if (!result.soundness.sound() && once < others.left())
    leave_out_small(prepare_with_hints, plain, others, prepared, result);
  if (!result.soundness.sound()) take_fallback(prepare_with_hints, plain, others, prepared, result);
  if (!result.soundness.sound()) leave_out_unsound(plain, prepared, result);
}

}  // namespace delquad
