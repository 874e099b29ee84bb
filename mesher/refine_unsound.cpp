#include "mesher/refine_unsound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/box.h"
#include "delquad/error.h"
#include "mesher/repair_options.h"

namespace delquad {
namespace {

/// How often a problem is meshed anew.
constexpr int kMostRounds = 8;
/// From this round on sharp edges in the spots become features.
constexpr int kFirstWithFeatures = 4;
/// The size becomes this part of what it was, so many of these sizes around.
constexpr double kPart = 0.5, kReach = 3;
/// Larger ones would ask for little else than the whole model.
constexpr std::size_t kMostSpots = 1000;

/// Places within so many sizes of a face that is an image count where its mesh comes from, too.
constexpr double kBeside = 3;

/// Where meshes of faces are made whose images are at these places.
std::vector<Vec3> places_of_masters(const PreparedProblem& prepared, const std::vector<Place>& places) {
  std::vector<Vec3> found;
  for (const PeriodicFaces& pair : prepared.boundary.periodic_faces) {
    const Mesh& fine = prepared.surface->model.fine;
    Box<Vec3> box;
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      if (fine.triangle_region[t] == pair.face)
        for (const int v : fine.triangles[t]) box.add(fine.points[v]);
    int hint = -1;
    for (const Place& place : places)
      if (std::sqrt(box.distance2(place.at)) <= kBeside * prepared.size->at(place.at, hint))
        found.push_back(pair.motion.inverse()(place.at));
  }
  return found;
}

/// Adds a ball around each place where the mesh is not sound, but for those inside of another new one.
void add_spots(const PreparedProblem& prepared, const Soundness& soundness, std::vector<SizeSpot>& spots) {
  const std::size_t first_new = spots.size();
  int hint = -1;
  const auto add = [&](const Vec3& at) {
    const bool is_known = std::any_of(spots.begin() + static_cast<std::ptrdiff_t>(first_new), spots.end(),
                                      [&](const SizeSpot& s) { return norm(s.at - at) < s.size; });
    if (is_known || spots.size() == kMostSpots) return;
    const double size = kPart * prepared.size->at(at, hint);
    if (prepared.surface && prepared.surface->mirrored) {
      // All images, too, so that what is kept for a part is kept for the whole.
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

void add_times(const StepTimes& times, StageLog& log) {
  for (const auto& [step, time] : times) log.add_time(step, time);
}

Warning warning_of(const PreparedProblem& prepared, const std::vector<SizeSpot>& spots) {
  const SizeSpot& least = *std::ranges::min_element(spots, {}, &SizeSpot::size);
  return fmt::format(
      "{}: around {} place(s) the size is smaller, as the mesh would not be sound: down to {:.3g} at "
      "({:.6g}, {:.6g}, {:.6g})",
      prepared.name, spots.size(), least.size, least.at.x, least.at.y, least.at.z);
}

}  // namespace

void refine_unsound(const PrepareAnew& prepare_anew, const Word& word, PreparedProblem& prepared,
                    RunResult& result) {
  // Lines that were given are kept.
  const bool can_be_finer = (prepared.surface && !prepared.given_entities) || !prepared.curve_places.empty();
  if (result.soundness.sound() || !can_be_finer || !repair_options(prepared.options).refine_unsound) return;
  StageLog before;
  double seconds = result.seconds;
  std::vector<SizeSpot> spots;
  add_spots(prepared, result.soundness, spots);
  add_times(prepared.times, before);
  add_times(result.log.times, before);
  for (int round = 1; round <= kMostRounds; ++round) try {
      const std::size_t n_spots = spots.size();
      if (n_spots == 0) return;
      PreparedProblem finer = prepare_anew({spots, round >= kFirstWithFeatures});
      RunResult run = run_word(finer, word);
      seconds += run.seconds;
      if (!run.soundness.sound()) {
        add_spots(finer, run.soundness, spots);
        if (spots.size() == n_spots) return;
        add_times(finer.times, before);
        add_times(run.log.times, before);
        continue;
      }
      add_times(before.times, run.log);
      add_summary(run.log, RefinementSummary{round, static_cast<int>(n_spots)});
      run.seconds = seconds;
      run.warnings.push_back(warning_of(finer, spots));
      prepared = std::move(finer);
      result = std::move(run);
      return;
    } catch (const InputError&) {
      return;  // too many elements, or a boundary that cannot be: what there was stays
    }
}

}  // namespace delquad
