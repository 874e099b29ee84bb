#include "mesher/keep_better.h"

#include <fmt/format.h>

#include <bit>
#include <utility>

#include "mesher/across_cuts.h"
#include "mesher/better_mesh.h"

namespace delquad {
namespace {

std::string text_of_worst(const RunResult& run) {
  const auto value = [&](const char* key) { return run.metrics.values.at(key); };
  return fmt::format(
      "{:.0f} quads, eta mean {:.4g}, worst {:.4g}, d4 {:.4g} %, aspect to {:.4g}, edges from {:.3g}{}",
      value("n_quads"), value("eta_mean"), value("eta_worst"), value("d4"), value("aspect_max"),
      value("edge_min"), run.soundness.sound() ? "" : ", not sound");
}

/// What these stages alone make.
RunResult made_by(const Finishing& f, const std::vector<const Stage*>& stages) {
  MeshingState state = begin_meshing(f.prepared);
  for (const Stage* stage : stages) run_stage(*stage, f.prepared, state);
  Finishing on{f.prepared, state, f.left_out};
  on.result.mesh = put_together(on);
  measure(f.prepared, f.left_out, on.result);
  if (repair_options(f.prepared.settings.options).across_cuts && are_cuts_in_the_way(f.prepared, stages))
    run_across_cuts(on);
  return std::move(on.result);
}

}  // namespace

bool keep_better(Finishing& on) {
  RunResult& result = on.result;
  RunResult before;
  before.mesh = assemble(on.prepared, on.prepared.boundary.points, on.state.given, on.left_out);
  measure(on.prepared, on.left_out, before);
  if (!is_worse(result, before)) return false;
  const std::string worse = text_of_worst(result), was = text_of_worst(before);
  const auto tell = [&](const std::string& what) {
    result.warnings.push_back(
        fmt::format("{}: {}: what was made of the given mesh ({}) would be worse ({}); "
                    "--set repair.keep_given=false takes it all the same",
                    on.label, what, was, worse));
  };
  // As many stages as can be, the last ones sooner.
  const std::vector<const Stage*>& stages = on.state.of_quads;
  const unsigned all = (1U << stages.size()) - 1;
  for (int n = static_cast<int>(stages.size()) - 1; n > 0; --n)
    for (unsigned mask = all; mask-- > 1;) {
      if (std::popcount(mask) != n) continue;
      std::vector<const Stage*> fewer;
      std::string word;
      for (std::size_t i = 0; i < stages.size(); ++i)
        if ((mask >> i & 1U) != 0) fewer.push_back(stages[i]), word += stages[i]->letter;
      RunResult run = made_by(on, fewer);
      if (is_worse(run, before)) continue;
      tell(fmt::format("{} alone ({})", word, text_of_worst(run)));
      take_mesh(std::move(run), result);
      return true;
    }
  tell("the given mesh is kept");
  take_mesh(std::move(before), result);
  return true;
}

}  // namespace delquad
