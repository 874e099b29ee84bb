#include "mesher/keep_better.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <utility>

#include "mesher/across_cuts.h"
#include "mesher/repair_options.h"

namespace delquad {
namespace {

/// Differences that count, as a part of the value.
constexpr double kChange = 1e-9;
/// The number of quads may differ by this part.
constexpr double kOtherNumber = 0.1;

std::string text_of_worst(const RunResult& run) {
  const auto value = [&](const char* key) { return run.metrics.values.at(key); };
  return fmt::format(
      "{:.0f} quads, eta mean {:.4g}, worst {:.4g}, d4 {:.4g} %, aspect to {:.4g}, edges from {:.3g}{}",
      value("n_quads"), value("eta_mean"), value("eta_worst"), value("d4"), value("aspect_max"),
      value("edge_min"), run.soundness.sound() ? "" : ", not sound");
}

/// What these stages alone make.
RunResult made_by(const PreparedProblem& prepared, const std::vector<const Stage*>& stages,
                  const std::vector<char>& left_out) {
  MeshingState state = begin_meshing(prepared);
  for (const Stage* stage : stages) run_stage(*stage, prepared, state);
  RunResult run;
  run.mesh = put_together(prepared, left_out, state);
  run.seconds = state.seconds;
  measure(prepared, left_out, run);
  if (are_cuts_in_the_way(prepared, stages)) run_across_cuts(prepared, stages, left_out, run);
  return run;
}

void take(RunResult from, RunResult& result) {
  result.mesh = std::move(from.mesh);
  result.metrics = std::move(from.metrics);
  result.soundness = std::move(from.soundness);
  result.surface = std::move(from.surface);
}

}  // namespace

bool is_worse(const RunResult& after, const RunResult& before) {
  if (before.soundness.sound() != after.soundness.sound()) return before.soundness.sound();
  /// By how much more there is after, as a part.
  const auto change = [&](const char* key) {
    const double was = before.metrics.values.at(key), is = after.metrics.values.at(key);
    return std::abs(is - was) > kChange * std::abs(was) ? is - was : 0;
  };
  if (change("eta_worst") < 0 || change("edge_min") < 0 || change("aspect_max") > 0) return true;
  if (std::abs(change("n_quads")) > kOtherNumber * before.metrics.values.at("n_quads")) return true;
  bool worse = false;
  for (const char* key : {"eta_mean", "eta_worst", "d4"}) {
    if (change(key) > 0) return false;
    worse = worse || change(key) < 0;
  }
  return worse;
}

void keep_better(const PreparedProblem& prepared, const std::string& label,
                 const std::vector<PatchMesh>& given, const std::vector<const Stage*>& stages,
                 const std::vector<char>& left_out, RunResult& result) {
  if (!repair_options(prepared.options).keep_given) return;
  RunResult before;
  before.mesh = assemble(prepared, prepared.boundary.points, given, left_out);
  measure(prepared, left_out, before);
  if (!is_worse(result, before)) return;
  const std::string worse = text_of_worst(result), was = text_of_worst(before);
  const auto tell = [&](const std::string& what) {
    result.warnings.push_back(
        fmt::format("{}: {}: what was made of the given mesh ({}) would be worse ({}); "
                    "--set repair.keep_given=false takes it all the same",
                    label, what, was, worse));
  };
  // As many stages as can be, the last ones sooner.
  const unsigned all = (1U << stages.size()) - 1;
  for (int n = static_cast<int>(stages.size()) - 1; n > 0; --n)
    for (unsigned mask = all; mask-- > 1;) {
      if (std::popcount(mask) != n) continue;
      std::vector<const Stage*> fewer;
      std::string word;
      for (std::size_t i = 0; i < stages.size(); ++i)
        if ((mask >> i & 1U) != 0) fewer.push_back(stages[i]), word += stages[i]->letter;
      RunResult run = made_by(prepared, fewer, left_out);
      result.seconds += run.seconds;
      if (is_worse(run, before)) continue;
      tell(fmt::format("{} alone ({})", word, text_of_worst(run)));
      return take(std::move(run), result);
    }
  tell("the given mesh is kept");
  take(std::move(before), result);
}

}  // namespace delquad
