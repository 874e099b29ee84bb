// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/experiment_copy.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/variant_work.h"
#include "metrics/tables/study_file.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Pipelines that begin alike, by their stages: a stage, the cell that ends with it, and what follows. Peers
/// come right after the root, without a stage, and last: those that are calibrated ask for a pipeline's
/// record.
struct Branch {
  const Stage* stage = nullptr;  ///< null at the root and for a peer
  const Cell* cell = nullptr;    ///< null where no pipeline ends here
  std::vector<Branch> next;
};

Branch make_tree(const std::vector<Cell>& cells, bool are_loops) {
  Branch root;
  for (const Cell& cell : cells) {
    Branch* at = &root;
    const bool is_alone = are_loops || cell.pipeline->stages.empty();
    for (const Stage* stage : is_alone ? std::vector<const Stage*>() : cell.pipeline->stages) {
      auto found = std::ranges::find(at->next, stage, &Branch::stage);
      if (found == at->next.end()) found = at->next.insert(found, Branch{stage, nullptr, {}});
      at = &*found;
    }
    if (is_alone) at = &root.next.emplace_back();
    at->cell = &cell;
  }
  std::ranges::stable_partition(root.next, [](const Branch& branch) { return branch.stage != nullptr; });
  return root;
}

void collect_cells(const Branch& branch, std::vector<const Cell*>& cells) {
  if (branch.cell != nullptr) cells.push_back(branch.cell);
  for (const Branch& next : branch.next) collect_cells(next, cells);
}

/// The end of a stretch of stages without a fork: there, cells end or pipelines part.
const Branch& end_of_stretch(const Branch& branch) {
  const Branch* at = &branch;
  while (at->cell == nullptr && at->next.size() == 1) at = &at->next[0];
  return *at;
}

void print_reason(const std::string& folder, const Cell& cell, const ProcessFailure& why) {
  if (why.kind == kNotApplicable) return;  // told once, at the end
  print_line(fmt::format("{}: {} {}: {}", cell.may_fail ? "failed, as it may" : "error", folder,
                         cell.pipeline->text, why.reason));
}

/// Returns a function that reports a failure for all unfinished cells of a branch.
std::function<void(const ProcessFailure&)> failure_of(const std::shared_ptr<VariantWork>& work,
                                                      const Branch& branch) {
  return [work, &branch](const ProcessFailure& why) {
    std::vector<const Cell*> cells;
    collect_cells(branch, cells);
    print_reason(work->c.folder, *cells[0], why);
    for (const Cell* cell : cells)
      if (!is_done(*cell)) work->fail(*cell, why);
  };
}

/// Runs a branch up to where it forks.
Job job_of(const std::shared_ptr<VariantWork>& work, const Branch& branch) {
  const Branch& end = end_of_stretch(branch);
  const bool is_leaf = end.next.empty();
  Job job;
  job.failed = failure_of(work, branch);
  job.work = [work, &branch, &end, is_leaf] {
    for (const Branch* at = &branch;; at = &at->next[0]) {
      if (at->stage == nullptr && at->cell == nullptr)
        work->prepare();
      else if (at->stage != nullptr)
        work->meshing->run(*at->stage);
      if (at == &end) break;
    }
    if (is_leaf) work->finish(*end.cell);
  };
  if (is_leaf) return job;
  job.next = [work, &end] {
    std::vector<Job> jobs;
    if (end.cell != nullptr) {
      Job ending;
      ending.work = [work, &end] { work->finish(*end.cell); };
      ending.failed = [work, &end](const ProcessFailure& why) {
        print_reason(work->c.folder, *end.cell, why);
        work->fail(*end.cell, why);
      };
      jobs.push_back(std::move(ending));
    }
    for (const Branch& next : end.next) jobs.push_back(job_of(work, next));
    return jobs;
  };
  return job;
}

class Sweep {
 public:
  /// `copy`: of the experiment's file, as seen from `folder`.
  Sweep(const Experiment& experiment, const fs::path& folder, const fs::path& copy,
        const SweepOptions& options)
      : experiment_(experiment),
        folder_(folder),
        copy_(copy),
        options_(options),
        progress_(shard_size(), options.place) {}

  /// Returns how many cells were interrupted.
  std::size_t run() {
    run_jobs([&] { return next_job(); }, options_.limits, [&] { progress_.draw(); });
    return progress_.n_interrupted();
  }

 private:
  std::size_t n_works() const { return experiment_.n_cases() * experiment_.n_variants(); }

  /// Whole variants go to a shard, so that pipelines share their stages, unless there are too few.
  bool is_in_shard(std::size_t work, std::size_t pipeline) const {
    const std::size_t n = experiment_.parsed.size();
    return (n_works() >= options_.shard.count ? work : work * n + pipeline) % options_.shard.count ==
           options_.shard.index;
  }

  std::size_t shard_size() const {
    std::size_t cells = 0;
    for (std::size_t i = 0; i < n_works(); ++i)
      for (std::size_t w = 0; w < experiment_.parsed.size(); ++w) cells += is_in_shard(i, w);
    return cells;
  }

  /// The next variant that has cells to make.
  std::optional<Job> next_job() {
    while (next_ < n_works()) {
      const std::size_t i = next_++;
      auto work = std::make_shared<VariantWork>();
      work->c = experiment_.read_variant(i / experiment_.n_variants(), i % experiment_.n_variants());
      work->progress = &progress_;
      work->allow_unsound = options_.allow_unsound;
      work->pictures = options_.pictures;
      const bool absent = work->c.may_be_absent && !fs::exists(model_path(work->c));
      add_cells(i, absent, *work);
      if (work->cells.empty()) continue;
      if (absent) {
        skip(*work);
        continue;
      }
      for (const Cell& cell : work->cells) remove_cell(cell.folder);
      const auto tree = std::make_shared<const Branch>(make_tree(work->cells, work->c.adapt.has_value()));
      Job job = job_of(work, *tree);
      job.work = [tree, run = std::move(job.work)] { run(); };  // keeps the tree alive
      return job;
    }
    return std::nullopt;
  }

  void add_cells(std::size_t i, bool absent, VariantWork& work) {
    std::string model;
    try {
      model = absent ? "" : model_digest(work.c);
    } catch (const InputError&) {  // the file cannot be read, as the cells will say
    }
    const MachineState start = machine_state();
    for (std::size_t w = 0; w < experiment_.parsed.size(); ++w) {
      if (!is_in_shard(i, w)) continue;
      const Pipeline& pipeline = experiment_.parsed[w];
      Cell cell{&pipeline, identify(experiment_, work.c, model, pipeline),
                cell_folder(folder_, work.c, pipeline)};
      cell.identity.experiment = copy_.generic_string();
      cell.identity.start = start;
      cell.reference = reference_of(cell, work.c, model);
      cell.may_fail = may_fail(experiment_, {work.c.name, work.c.variant, pipeline.text});
      if (!options_.force && is_done(cell))
        progress_.found(1);
      else
        work.cells.push_back(std::move(cell));
    }
  }

  /// The cell of the pipeline that a peer is calibrated to, if it is run, too.
  ReferenceCell reference_of(const Cell& cell, const Case& c, const std::string& model) const {
    const Peer* peer = cell.identity.peer;
    if (peer == nullptr || peer->calibrate_to.empty()) return {};
    const auto at = std::ranges::find(experiment_.parsed, peer->calibrate_to, &Pipeline::text);
    if (at == experiment_.parsed.end()) return {};
    return {cell_folder(folder_, c, *at), identify(experiment_, c, model, *at).key};
  }

  void skip(const VariantWork& work) {
    const ProcessFailure why = {"data not found", "data not found, skipped: " + model_path(work.c).string()};
    print_line(work.c.folder + ": " + why.reason);
    for (const Cell& cell : work.cells) work.give_up(cell, "skipped", why);
  }

  const Experiment& experiment_;
  const fs::path& folder_;
  const fs::path& copy_;
  const SweepOptions& options_;
  SweepProgress progress_;
  std::size_t next_ = 0;
};

}  // namespace

std::string why_folder_is_refused(const Experiment& experiment, const fs::path& folder) {
  const auto study = folder.empty() ? std::nullopt : read_study(folder);
  const std::string name = experiment.file.stem().string();
  if (!study || study->experiment == name) return "";
  return fmt::format("{}: holds results of the experiment '{}', not of '{}': give another folder",
                     folder.string(), study->experiment, name);
}

bool is_plan_changed(const StudyFile& study, const fs::path& folder) {
  const StudyFile before = read_study(folder).value_or(StudyFile());
  return before.plan_changed ||
         (!have_same_plan(before, study) && fs::exists(folder) && !record_files(folder).empty());
}

Outcome run_experiment(const Experiment& experiment, const fs::path& folder, const SweepOptions& options) {
  prepare_folder(folder);
  const FolderLock lock(folder, options.shard.index, options.shard.count);
  if (const std::string why = why_folder_is_refused(experiment, folder); !why.empty()) throw InputError(why);
  experiment.check_hypotheses();
  StudyFile study = describe(experiment);
  study.plan_changed = is_plan_changed(study, folder);
  if (study.plan_changed && !study.hypotheses.empty()) print_line(std::string("warning: ") + kNotPlanned);
  const fs::path copy = keep_experiment(experiment, folder);
  write_study(folder, study);
  const std::size_t interrupted = Sweep(experiment, folder, copy, options).run();
  Outcome outcome = make_tables(folder);
  outcome.others_failed += static_cast<int>(interrupted);
  if (interrupted > 0) outcome.failures[counted(interrupted, "cell") + " ended by other programs: run again"];
  for (const std::string& error : write_tables(folder, outcome)) {
    ++outcome.bad_inputs;
    outcome.failures[error];
  }
  return outcome;
}

}  // namespace delquad
