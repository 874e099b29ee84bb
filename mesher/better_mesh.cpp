#include "mesher/finish_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace delquad {
namespace {

/// Differences that count, as a part of the value.
constexpr double kChange = 1e-9;
/// The number of quads may differ by this part.
constexpr double kOtherNumber = 0.1;
/// Edges are near enough to their size with this tau, in percent.
constexpr double kGoodTau = 91;

double value(const RunResult& run, const char* key) { return run.metrics.values.at(key); }

/// Not below both what is good and what there was.
bool is_kept(const char* key, double good, const RunResult& after, const RunResult& before) {
  constexpr double kRounding = 1e-9;
  return value(after, key) > std::min(good, value(before, key)) - kRounding;
}

double score(const RunResult& run) {
  return value(run, "eta_mean") + value(run, "eta_worst") + value(run, "d4") / 100;
}

}  // namespace

bool is_worse(const RunResult& after, const RunResult& before) {
  if (before.soundness.sound() != after.soundness.sound()) return before.soundness.sound();
  /// By how much more there is after.
  const auto change = [&](const char* key) {
    const double was = value(before, key), is = value(after, key);
    return std::abs(is - was) > kChange * std::abs(was) ? is - was : 0;
  };
  if (change("eta_worst") < 0 || change("edge_min") < 0 || change("aspect_max") > 0) return true;
  if (std::abs(change("n_quads")) > kOtherNumber * value(before, "n_quads")) return true;
  bool worse = false;
  for (const char* key : {"eta_mean", "eta_worst", "d4"}) {
    if (change(key) > 0) return false;
    worse = worse || change(key) < 0;
  }
  return worse;
}

bool is_better(const RunResult& after, const RunResult& before) {
  return score(after) > score(before) && !is_worse(after, before);
}

bool is_more_regular(const RunResult& after, const RunResult& before) {
  return value(after, "n_irregular") < value(before, "n_irregular") &&
         is_kept("tau", kGoodTau, after, before);
}

bool keeps_worst_eta(double eta, const RunResult& after, const RunResult& before) {
  return is_kept("eta_worst", eta, after, before);
}

void take_mesh(RunResult&& from, RunResult& result) {
  result.mesh = std::move(from.mesh);
  result.metrics = std::move(from.metrics);
  result.soundness = std::move(from.soundness);
  result.surface = std::move(from.surface);
}

}  // namespace delquad
