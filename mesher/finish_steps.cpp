// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/finish_steps.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include "algorithms/finish/lift_bad_quads.h"
#include "algorithms/finish/separate_duplicates.h"
#include "algorithms/treatment/treatment.h"
#include "base/activity.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "features/curved/curved_mesh.h"
#include "features/given/given_worst.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/poor_quads.h"

namespace delquad {
namespace {

std::string text_of_worst(const MeshResult& run) {
  const auto value = [&](const char* key) { return run.metrics.values.at(key); };
  return fmt::format(
      "{:.0f} quads, eta mean {:.4g}, worst {:.4g}, d4 {:.4g} %, aspect to {:.4g}, edges from {:.3g}{}",
      value("n_quads"), value("eta_mean"), value("eta_worst"), value("d4"), value("aspect_max"),
      value("edge_min"), run.soundness.sound() ? "" : ", not sound");
}

/// Returns whether the first stage begins from the given mesh, and each other from the result of the one
/// before.
bool continues_quads(const std::vector<const Stage*>& stages, const Stage* first) {
  const auto follows = [](const Stage* before, const Stage* after) { return before->to != after->from; };
  return stages[0]->from == first->from && stages.back()->to == PatchForm::kQuads &&
         std::ranges::adjacent_find(stages, follows) == stages.end();
}

/// Returns the mesh that these stages alone make.
MeshResult mesh_of_stages(const FinishContext& f, const std::vector<const Stage*>& stages) {
  PipelineState state = begin_meshing(f.prepared);
  for (const Stage* stage : stages) run_stage(*stage, f.prepared, state);
  FinishContext on{f.prepared, state, f.left_out};
  on.result.mesh = finish_patches(on);
  measure(f.prepared, f.left_out, on.result);
  if (repair_options(f.prepared.settings.options).across_cuts && cuts_obstruct(f.prepared, state.of_quads))
    run_across_cuts(on);
  return std::move(on.result);
}

/// Warns of measures that became worse while given quads became sound; if too much was lost, the mesh is not
/// accepted.
void warn_of_price(FinishContext& on, const MeshResult& before) {
  const std::string price = text_of_price(on.prepared, on.result, before);
  if (costs_too_much(on.result, before) && !repair_options(on.prepared.settings.options).at_any_price)
    on.result.soundness.beyond.push_back(
        fmt::format("given quads that are inverted, folded or flat become sound only at a price: {}; "
                    "--set repair.at_any_price=true takes it",
                    price));
  else
    on.result.warnings.push_back(fmt::format(
        "{}: given quads that were inverted, folded or flat are sound now, at a price: {}", on.label, price));
}

/// Replaces the mesh that the stages made of given quads if it is worse than these, see is_worse(). If
/// criteria are given and fewer quads fail, the new mesh stays. Takes the mesh of fewer stages if it is not
/// worse, else the given mesh. A warning says so.
void keep_better(FinishContext& on) {
  MeshResult& result = on.result;
  MeshResult given;
  given.mesh = assemble(on.prepared, on.prepared.boundary.points, on.state.given, on.left_out);
  measure(on.prepared, on.left_out, given);
  const std::optional<GivenWorst>& worst = on.prepared.given_worst;  // nothing if the mesh has triangles only
  const MeshResult before = worst ? as_it_was(given, *worst) : given;
  const bool aims = !on.prepared.settings.criteria.empty() && on.prepared.surface;
  const double failing = aims ? failing_part(on.prepared, given.mesh) : 0;
  const auto is_harmful = [&](const MeshResult& run) {
    return is_worse(run, before) &&
           !(aims && run.soundness.sound() && failing_part(on.prepared, run.mesh) < failing);
  };
  if (!is_harmful(result)) return;
  const std::string worse = text_of_worst(result), was = text_of_worst(before);
  const auto warn = [&](const std::string& what) {
    result.warnings.push_back(
        fmt::format("{}: {}: the given mesh ({}) would become worse ({}). --set repair.keep_given=false "
                    "takes the worse mesh [would-be-worse]",
                    on.label, what, was, worse));
  };
  // The repair of an unsound mesh with the least harm.
  std::optional<MeshResult> best;
  double least =
      result.soundness.sound() ? degradation_of(result, before).sum() : std::numeric_limits<double>::max();
  const auto is_good = [&](MeshResult& run) {
    const bool is_repaired = run.soundness.sound() || !(result.soundness.sound() || best);
    if (is_repaired && !is_harmful(run)) return true;
    const double degradation = degradation_of(run, before).sum();
    if (!run.soundness.sound() || before.soundness.sound() || degradation >= least) return false;
    least = degradation;
    best = std::move(run);
    return false;
  };
  // Keeps as many stages as possible, and drops the last ones first.
  const std::vector<const Stage*>& stages = on.state.stages;
  const unsigned all = (1U << stages.size()) - 1;
  for (int n = static_cast<int>(stages.size()) - 1; n > 0; --n)
    for (unsigned mask = all; mask-- > 1;) {
      std::vector<const Stage*> fewer;
      std::string pipeline;
      for (std::size_t i = 0; i < stages.size(); ++i)
        if ((mask >> i & 1U) != 0) fewer.push_back(stages[i]), pipeline += stages[i]->letter;
      if (std::popcount(mask) != n || !continues_quads(fewer, stages[0])) continue;
      MeshResult run = mesh_of_stages(on, fewer);
      if (!is_good(run)) continue;
      warn(fmt::format("{} alone ({})", pipeline, text_of_worst(run)));
      take_mesh(std::move(run), result);
      return;
    }
  if (is_good(given)) {
    warn("the given mesh is kept");
    take_mesh(std::move(given), result);
    return;
  }
  if (best) take_mesh(std::move(*best), result);
  if (result.soundness.sound()) warn_of_price(on, before);
}

bool is_surface(const FinishContext& f) { return f.prepared.surface != nullptr; }
bool is_curved(const FinishContext& f) { return f.prepared.settings.order > 1; }
bool should_curve(const FinishContext& f) { return is_curved(f) && f.result.soundness.sound(); }
bool starts_from_given(const FinishContext& f) { return !f.state.given.empty(); }
/// Returns whether quads are treated; before a treatment they are bad in the plane, too.
bool is_treated(const FinishContext& f) {
  return is_surface(f) && !f.prepared.surface->metric &&
         recombination_options(f.prepared.settings.options).treatment == Treatment::kPaper;
}
/// Returns whether criteria were given that apply. Limits for straight elements say nothing of curved ones,
/// and pipelines that end with a matching are those in the paper.
bool has_criteria(const FinishContext& f) {
  return is_treated(f) && !f.prepared.settings.criteria.empty() && !is_curved(f) && !f.state.of_quads.empty();
}
/// Returns whether other cuts may be tried: not on an unsound mesh, which refine_unsound() makes again, and
/// not with layers, which stay.
bool may_try_other_cuts(const FinishContext& f) {
  return !(f.prepared.surface && f.prepared.surface->metric) && !f.prepared.layers &&
         cuts_obstruct(f.prepared, f.state.of_quads) &&
         (f.result.soundness.sound() || f.prepared.surface->given);
}

void part(FinishContext& on) {
  const std::vector<char> left_out = unedited_patches(on.prepared, on.state);
  const SeparationSummary separated = separate_duplicates(
      {on.prepared, on.prepared.settings.options, on.state.patches, left_out, on.state.nodes});
  add_summary(on.result.log, separated);
}

/// Returns for each patch whether lifting leaves it out.
std::vector<char> unlifted_patches(const FinishContext& f) {
  std::vector<char> left_out;
  for (const PatchSetup& patch : f.prepared.patches)
    left_out.push_back(f.left_out[patch.region] || (patch.grid && patch.grid_stays) || patch.given_stays);
  return left_out;
}

void lift(FinishContext& on) {
  const std::vector<char> left_out = unlifted_patches(on);
  const LiftingSummary lifted =
      lift_bad_quads({on.prepared, on.prepared.settings.options, on.state.patches, left_out, on.state.nodes});
  if (lifted.stopped > 0) on.result.warnings.push_back(stopped_early(on.prepared, "lifting", lifted.stopped));
  on.result.lifting_cost = lifted.cost;
  add_summary(on.result.log, lifted);
}

void repair_failing(FinishContext& on) {
  const std::vector<char> left_out = unlifted_patches(on);
  const ProblemSettings& settings = on.prepared.settings;
  add_summary(
      on.result.log,
      repair_failing_quads({on.prepared, settings.options, on.state.patches, left_out, on.state.nodes},
                           {requested_size(on.prepared), settings.limits, excess_of(settings.criteria)}));
}

void split_corners(FinishContext& on) {
  const int rings = split_flat_corners(on.prepared, on.state.nodes, on.result.mesh);
  on.result.log.summaries.add("flat_corners", {{"rings", static_cast<long long>(rings)}});
}

void curve(FinishContext& on) {
  MeshResult& result = on.result;
  CurvingSummary summary;
  const bool moved =
      curve_mesh(on.prepared, on.state.nodes, result.mesh, result.soundness, result.warnings, summary);
  add_summary(result.log, summary);
  if (moved) measure_straight_form(on.prepared, on.left_out, on.result);
}

void run(const FinishStep& step, FinishContext& on) {
  const StageScope doing(step.time);
  const Stopwatch watch;
  step.run(on);
  const TimeSpent time = watch.time();
  if (step.at == FinishAt::kMeasured) on.result.seconds += watch.seconds();
  on.result.log.add_time(step.time, time);
  note_seconds(step.name, time.seconds, on.result.log.summaries);
}

}  // namespace

const std::vector<FinishStep>& finish_steps() {
  using R = RepairOptions;
  static const std::vector<FinishStep> all = {
      {"part_twins", "parting", &R::separate_duplicates, FinishAt::kEveryStage, is_surface, part},
      {"lift_bad_quads", "lifting", &R::lift_bad_quads, FinishAt::kPatches, is_treated, lift},
      {"failing_quads", "repairing", &R::failing_quads, FinishAt::kPatches, has_criteria, repair_failing},
      {"flat_corners", "flat corners", &R::flat_corners, FinishAt::kMesh, is_curved, split_corners},
      {"across_cuts", "other cuts", &R::across_cuts, FinishAt::kMeasured, may_try_other_cuts,
       run_across_cuts},
      {"keep_given", "keeping", &R::keep_given, FinishAt::kMeasured, starts_from_given, keep_better},
      {"curving", "curving", nullptr, FinishAt::kMeasured, should_curve, curve},
      {"refine_unsound", "refining", &R::refine_unsound, FinishAt::kProblem, nullptr, nullptr},
  };
  return all;
}

void run_finish_steps(FinishAt at, FinishContext& on) {
  const RepairOptions options = repair_options(on.prepared.settings.options);
  const auto runs = [&](const FinishStep& step) {
    return step.at == at && (step.option == nullptr || options.*step.option) && step.applies(on);
  };
  if (at == FinishAt::kPatches && std::ranges::any_of(finish_steps(), runs)) {
    const Stopwatch watch;
    const std::vector<char> left_out = unlifted_patches(on);
    place_inside({on.prepared, on.prepared.settings.options, on.state.patches, left_out, on.state.nodes});
    on.result.log.add_time("projection", watch.time());
  }
  for (const FinishStep& step : finish_steps())
    if (runs(step)) run(step, on);
}

void note_seconds(const char* step, double seconds, Summaries& summaries) {
  for (const char* of : {step, "finish"}) summaries.add(of, {{"seconds", seconds}});
}

namespace {

const OptionTable<RepairOptions>& repair_table() {
  static const auto all =
      OptionTable<RepairOptions>("repair", "what happens beside the stages")
          .add({.name = "part_twins",
                .help = "on surfaces: whether duplicate edges and quads of two faces are separated"},
               &RepairOptions::separate_duplicates)
          .add({.name = "lift_bad_quads",
                .help = "on surfaces: whether quads that are bad in space are improved there"},
               &RepairOptions::lift_bad_quads)
          .add({.name = "failing_quads",
                .help = "on surfaces with criteria: whether quads that fail are repaired"},
               &RepairOptions::failing_quads)
          .add({.name = "flat_corners",
                .help = "for curved elements: whether quads with flat corners get a ring of quads"},
               &RepairOptions::flat_corners)
          .add({.name = "across_cuts", .help = "on surfaces: whether stages run once more with other cuts"},
               &RepairOptions::across_cuts)
          .add({.name = "refine_unsound",
                .help = "whether sizes are made smaller where the mesh would not be sound"},
               &RepairOptions::refine_unsound)
          .add({.name = "ignore_small",
                .help = "on surfaces: whether parts narrower than a tenth of the size are left out if the "
                        "mesh would not be sound"},
               &RepairOptions::ignore_small)
          .add({.name = "keep_given", .help = "whether given quads stay where they would become worse"},
               &RepairOptions::keep_given)
          .add({.name = "at_any_price",
                .help = "whether given quads become sound where others become poor by it"},
               &RepairOptions::at_any_price);
  return all;
}

}  // namespace

OptionGroup repair_group() { return repair_table().group(); }
RepairOptions repair_options(const Options& options) { return repair_table().read(options); }

}  // namespace delquad
