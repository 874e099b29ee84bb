#include "mesher/finish_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "features/given/given_worst.h"
#include "metrics/judgement/poor_quads.h"

namespace delquad {
namespace {

/// Differences that count, as a part of the value.
constexpr double kChange = 1e-9;
/// Edges are near enough to their size with this tau, in percent.
constexpr double kGoodTau = 91;

double value(const MeshResult& run, const char* key) { return run.metrics.values.at(key); }

/// Not below both what is good and what there was.
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
  if (harm_of(after, before).sum() > 0) return true;
  if (after.soundness.sound() && !before.soundness.sound()) return false;
  bool worse = false;
  for (const char* key : {"eta_mean", "eta_worst", "d4"}) {
    const double was = value(before, key), is = value(after, key);
    if (std::abs(is - was) <= kChange * std::abs(was)) continue;
    if (is > was) return false;
    worse = true;
  }
  return worse;
}

bool is_better(const PreparedProblem& prepared, const MeshResult& after, const MeshResult& before) {
  const double is = failing_part(prepared, after.mesh), was = failing_part(prepared, before.mesh);
  return (is == was ? score(after) > score(before) : is < was) && !is_worse(after, before);
}

bool is_more_regular(const PreparedProblem& prepared, const MeshResult& after, const MeshResult& before) {
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
