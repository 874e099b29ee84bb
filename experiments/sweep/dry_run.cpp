// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/text.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/run_experiment.h"
#include "metrics/anisotropic_measures.h"
#include "metrics/judgement/criteria.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/inference.h"

// This file tells which cells a run would make, and which differences it could prove.

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Returns the measures of a case that are not in the registry.
std::vector<Metric> added_metrics_of(const Experiment& experiment, const Case& c) {
  std::vector<Metric> own;
  const auto add = [&](const std::vector<Metric>& more) { own.insert(own.end(), more.begin(), more.end()); };
  if (!c.criteria.limits.empty()) add(criteria_metrics());
  if (c.metric.asks()) add(anisotropic_measures());
  for (const std::string& solver : experiment.solvers) add(metrics_of_solver(solver));
  for (const MetricCommand& command : experiment.metrics) own.push_back(command.metric);
  return own;
}

/// As if it had a mesh, as good as its number: no two cells have the same values.
void add_planned_values(const Experiment& experiment, const Case& c, const Pipeline& pipeline, double number,
                        CellRecord& cell) {
  if (pipeline.result != PatchForm::kQuads || cell.kind == kNotApplicable) return;
  cell.added_metrics = added_metrics_of(experiment, c);
  for (const Metric& metric : metric_registry()) cell.values[metric.key] = number;
  for (const Metric& metric : cell.added_metrics) cell.values[metric.key] = number;
  for (const Hypothesis& hypothesis : experiment.hypotheses)
    for (const std::string& key : hypothesis.measures)
      if (cell.values.contains(key.substr(0, key.find('.')))) cell.values[key] = number;
  cell.values["n_quads"] = 1;
  cell.values["n_triangles"] = pipeline.quads_only() ? 0 : 1;
}

/// The cells in their order; `kind` is what there is of them.
std::vector<CellRecord> planned_cells(const Experiment& experiment, const StudyFile& study,
                                      const fs::path& folder) {
  const std::map<std::string, std::string> domains = domains_of(study);
  std::vector<CellRecord> cells;
  for (std::size_t i = 0; i < experiment.n_cases(); ++i)
    for (std::size_t v = 0; v < experiment.n_variants(); ++v) {
      const Case c = experiment.read_variant(i, v);
      const bool absent = c.may_be_absent && !fs::exists(model_path(c));
      const std::string model = absent ? "" : model_digest(c);
      for (const Pipeline& pipeline : experiment.parsed) {
        const CellIdentity identity = identify(experiment, c, model, pipeline);
        CellRecord& cell = cells.emplace_back(
            CellRecord{c.folder, pipeline.text, "", {}, c.name, domains.at(c.name), model});
        cell.variant = c.variant;
        cell.skipped = absent;
        cell.kind = absent           ? "data not found"
                    : folder.empty() ? "to do"
                                     : state_of_cell(cell_folder(folder, c, pipeline), identity.key);
        if (absent) cell.reason = cell.kind;
        add_planned_values(experiment, c, pipeline, static_cast<double>(cells.size()), cell);
      }
    }
  return cells;
}

std::string text_of_cells(const std::vector<CellRecord>& cells) {
  std::string text;
  for (const CellRecord& cell : cells)
    text += fmt::format("{:<14} {} {}\n", cell.kind, cell.group, cell.pipeline);
  return text;
}

bool needs_no_run(const CellRecord& cell) { return cell.kind == "done" || cell.kind == kNotApplicable; }

/// By the mean of the records of the same pipeline, on the same case where there are some: by the clock,
/// added up over threads.
std::string time_text(const Experiment& experiment, const std::vector<CellRecord>& cells,
                      const fs::path& folder) {
  std::map<std::string, std::vector<double>> known;
  if (fs::is_directory(folder) && !record_files(folder).empty())
    for (const CellRecord& record : read_records(folder))
      if (const double seconds = value_of(record, "seconds_total"); seconds >= 0)
        for (const std::string& key : {record.pipeline, record.name + "/" + record.pipeline})
          known[key].push_back(seconds);
  double seconds = 0;
  int unknown = 0, guessed = 0;
  for (const CellRecord& cell : cells) {
    if (cell.skipped || needs_no_run(cell)) continue;
    auto at = known.find(cell.name + "/" + cell.pipeline);
    if (at == known.end()) {
      at = known.find(cell.pipeline);
      ++(at == known.end() ? unknown : guessed);
    }
    if (at != known.end()) seconds += mean(at->second);
  }
  if (known.empty() && experiment.minutes > 0)
    return fmt::format("time: about {:.3g} min on two cores, as the experiment says\n",
                       *expected_seconds(experiment, folder) / 60);
  if (known.empty()) return "time: not known, without records of such cells in the folder of -o\n";
  constexpr double kHour = 3600;
  return fmt::format(
      "time: about {} by the clock of one core of this machine, if the records in the folder of -o were made "
      "on "
      "it{}{}\n",
      seconds < kHour ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.3g} h", seconds / kHour),
      guessed > 0 ? fmt::format("; {} guessed from other cases", counted(guessed, "cell")) : "",
      unknown > 0 ? fmt::format("; and {} of whose pipelines there is no record", counted(unknown, "cell"))
                  : "");
}

std::string domains_text(const std::vector<CellRecord>& cells) {
  std::map<std::string, std::vector<std::string>> cases;  // by domain
  for (const CellRecord& cell : cells)
    if (auto& names = cases[domain_of(cell)];
        !cell.skipped && std::ranges::find(names, cell.name) == names.end())
      names.push_back(cell.name);
  std::erase_if(cases, [](const auto& domain) { return domain.second.empty(); });
  std::string text = fmt::format("domains (geometries): {}\n", cases.size());
  for (const auto& [domain, names] : cases)
    if (names.size() > 1) text += fmt::format("  one domain: {}\n", fmt::join(names, ", "));
  return text;
}

/// The tests of a design, all of them as clear as they can be.
class TestDesign {
 public:
  TestDesign(const StudyFile& study, const std::vector<CellRecord>& cells)
      : inference_(study, cells), is_planned_(!study.hypotheses.empty()) {}

  std::string text() const {
    const ClaimFamily now = at_best(0);
    std::string text = is_planned_ ? fmt::format("tests of hypotheses: {}\n", now.size())
                                   : fmt::format("tests: at most {}, of which {} could prove something\n",
                                                 now.size(), now.counted());
    // Tests of the same power are told together.
    std::map<std::size_t, std::vector<std::size_t>> by_domains;
    for (const PairComparison& pair : is_planned_ ? inference_.hypotheses() : inference_.pairs())
      by_domains[pair.domains.names.size()].push_back(pair.test);
    for (const auto& [domains, tests] : by_domains)
      text += fmt::format("  {} over {} domains: {}\n", tests.size(), domains, line(domains, tests[0], now));
    return text;
  }

 private:
  /// With `more` domains than there are.
  ClaimFamily at_best(int more) const {
    const ClaimFamily& planned = is_planned_ ? inference_.planned() : inference_.family();
    ClaimFamily family;
    for (std::size_t i = 0; i < planned.size(); ++i) {
      const double p = std::ldexp(planned.test(i).least_p, -more);
      family.add({p, p, 0});
    }
    family.decide();
    return family;
  }

  /// Tells about tests that have as many domains.
  std::string line(std::size_t domains, std::size_t test, const ClaimFamily& now) const {
    if (now.finding(test) != Finding::kProven) {
      int more = 1;
      while (at_best(more).finding(test) != Finding::kProven) ++more;
      return fmt::format("nothing can be proven; it takes {} domains",
                         domains + static_cast<std::size_t>(more));
    }
    return fmt::format("p corrected {} at the least", p_text(now.adjusted_p(test)));
  }

  Inference inference_;
  bool is_planned_;
};

}  // namespace

std::optional<double> expected_seconds(const Experiment& experiment, const fs::path& folder) {
  if (experiment.minutes == 0) return std::nullopt;
  constexpr double kMinute = 60;
  const std::vector<CellRecord> cells = planned_cells(experiment, describe(experiment), folder);
  const auto left = std::ranges::count_if(
      cells, [](const CellRecord& cell) { return !cell.skipped && !needs_no_run(cell); });
  return kMinute * experiment.minutes * static_cast<double>(left) / static_cast<double>(cells.size());
}

std::string list_cells(const Experiment& experiment, const fs::path& folder) {
  return text_of_cells(planned_cells(experiment, describe(experiment), folder));
}

std::string dry_run(const Experiment& experiment, const fs::path& folder) {
  experiment.check_hypotheses();
  const std::string refusal = why_folder_is_refused(experiment, folder);
  const StudyFile study = describe(experiment);
  const std::vector<CellRecord> cells = planned_cells(experiment, study, refusal.empty() ? folder : "");
  const bool is_late = !study.hypotheses.empty() && !folder.empty() && is_plan_changed(study, folder);
  const std::string warning = refusal.empty() && is_late ? kNotPlanned : refusal;
  return text_of_cells(cells) + (warning.empty() ? "" : "warning: " + warning + "\n") +
         fmt::format("cells: {}, of which {} are done\n", cells.size(),
                     std::ranges::count_if(cells, needs_no_run)) +
         time_text(experiment, cells, folder) + domains_text(cells) + TestDesign(study, cells).text();
}

}  // namespace delquad
