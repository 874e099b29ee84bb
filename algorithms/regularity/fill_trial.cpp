// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/fill_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh/quad_corners.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad {

namespace {

/// A remaining irregular vertex counts as this many quads.
constexpr double kQuadsPerIrregular = 10;
/// Quads of a cavity for each removed irregular vertex in the first round, and growth of this limit by round.
/// The last round has no limit. One in thirty fills of larger cavities would be kept.
constexpr double kQuadsPerGain = 15, kMoreQuads = 3;
/// Sweeps of relocation before a fill is judged.
constexpr int kFillSweeps = 12;
/// A fill is given up if a sweep gains less than this part of its excess loss, or of its worst corner's lack.
constexpr double kHopelessPart = 0.2;
/// A fill is also given up if its excess loss is above this times the square root of the quads around.
/// Without it, relocation costs half as much again for equal results on the plate of 16 holes. A value of 1.2
/// saves a fifth of the cost and removes 2 % fewer irregular vertices.
constexpr double kHopelessLoss = 1.6;

/// Moves below this part of an edge do not activate neighbors in the end.
constexpr double kRelaxedAtLast = 0.02;

bool is_slow(double repaired, double deficit) { return deficit > 0 && repaired < kHopelessPart * deficit; }

}  // namespace

double tolerance_of(const RegularityOptions& options, int round) {
  return options.rounds > 1 ? options.tolerance * round / (options.rounds - 1) : options.tolerance;
}

double quads_per_gain_of(const RegularityOptions& options, int round) {
  return round + 1 < options.rounds ? kQuadsPerGain * std::pow(kMoreQuads, round) : options.quads;
}

double promise_of(double quads, int left, int gain) { return (quads + kQuadsPerIrregular * left) / gain; }

void limit_relocation(QuadRelocation& relocation) {
  relocation.keep_convex_corners();
  relocation.hold_lengths();
  relocation.keep_sines_above(sine_of_eta(kFloorEta));
}

long long relax_at_last(QuadRelocation& relocation) {
  const long long moves = relocation.relax(kRelaxedAtLast, 30);
  return moves + relocation.lift_worst(kFloorEta, 10);
}

void FillTrial::collect_region(const Cavity& cavity) {
  region.clear();
  vertices_met_.begin(mesh_.vertex_slots());
  for (const int h : cavity.rim())
    mesh_.for_each_out(mesh_.origin(h), [&](int g) {
      const int e = QuadTopology::element(g);
      for (int k = 0; k < 4; ++k)
        if (const int v = mesh_.corner(e, k); v >= 0 && !cavity.is_inside(v) && vertices_met_.meet(v))
          region.push_back(v);
    });
}

void FillTrial::collect_elements() {
  elements_.clear();
  elements_met_.begin(mesh_.element_slots());
  for_each_element_around(mesh_, region, elements_met_, [&](int e) { elements_.push_back(e); });
}

void FillTrial::measure_before() {
  collect_elements();
  before = quality();
}

FillTrial::Quality FillTrial::quality() const {
  ElementQuality total;
  for (const int e : elements_) total.add(element_quality(mesh_, relocation_, e));
  const int n = static_cast<int>(elements_.size());
  return {total.value / std::max(n, 1), total.least_sine, total.failing, total.thin, total.crowding, n};
}

void FillTrial::sweep() {
  for (const int v : region) relocation_.step(v);
}

bool settle(FillTrial& trial, double allowed, double& loss, long long& tried) {
  const FillTrial::Quality& before = trial.before;
  const double least = std::min(before.least_sine, sine_of_eta(kFloorEta));
  const double hopeless = allowed + kHopelessLoss / std::sqrt(before.n);
  double last_loss = 0, last_sine = 0;
  for (int sweep = 0; sweep <= kFillSweeps; ++sweep) {
    if (sweep == 1) ++tried;
    if (sweep > 0) trial.sweep();
    const FillTrial::Quality after = trial.quality();
    loss = before.mean - after.mean;
    if (after.least_sine >= least && after.thin <= before.thin && after.crowding <= before.crowding &&
        after.failing <= before.failing && loss <= allowed)
      return true;
    if (loss > hopeless) return false;
    if (sweep > 2 && is_slow(last_loss - loss, loss - allowed)) return false;
    if (sweep > 2 && is_slow(after.least_sine - last_sine, least - after.least_sine)) break;
    last_loss = loss, last_sine = after.least_sine;
  }
  // A larger allowed loss would not make a corner better.
  if (loss <= allowed) loss = std::numeric_limits<double>::infinity();
  return false;
}

}  // namespace delquad
