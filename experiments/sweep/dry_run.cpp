#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/text.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/run_experiment.h"
#include "metrics/judgement/criteria.h"
#include "metrics/metric_measures.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/inference.h"

// What a run would do, and what it could prove.

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// What is measured of a case beside the registry.
std::vector<Metric> own_measures_of(const Experiment& experiment, const Case& c) {
  std::vector<Metric> own;
  const auto add = [&](const std::vector<Metric>& more) { own.insert(own.end(), more.begin(), more.end()); };
  if (!c.criteria.limits.empty()) add(criteria_metrics());
  if (c.metric.asks()) add(metrics_by_metric());
  for (const std::string& solver : experiment.solvers) add(metrics_of_solver(solver));
  for (const MetricCommand& command : experiment.metrics) own.push_back(command.metric);
  return own;
}

/// As if it had a mesh, as good as its number: no two cells have the same values.
void add_planned_values(const Experiment& experiment, const Case& c, const Word& word, double number,
                        CellRecord& cell) {
  if (word.result != PatchForm::kQuads || cell.kind == kNotApplicable) return;
  cell.own_metrics = own_measures_of(experiment, c);
  for (const Metric& metric : metric_registry()) cell.values[metric.key] = number;
  for (const Metric& metric : cell.own_metrics) cell.values[metric.key] = number;
  for (const Hypothesis& hypothesis : experiment.hypotheses)
    for (const std::string& key : hypothesis.measures)
      if (cell.values.contains(key.substr(0, key.find('.')))) cell.values[key] = number;
  cell.values["n_quads"] = 1;
  cell.values["n_triangles"] = word.quads_only() ? 0 : 1;
  if (experiment.repeat_times > 0)
    cell.times[time_key(experiment)].assign(static_cast<std::size_t>(experiment.repeat_times), number);
}

/// The cells in their order; `kind` is what there is of them.
std::vector<CellRecord> planned_cells(const Experiment& experiment, const fs::path& folder) {
  std::vector<CellRecord> cells;
  for (std::size_t i = 0; i < experiment.n_cases(); ++i)
    for (std::size_t v = 0; v < experiment.n_variants(); ++v) {
      const Case c = experiment.read_variant(i, v);
      const bool absent = c.may_be_absent && !fs::exists(model_path(c));
      const std::string model = absent ? "" : model_digest(c);
      for (const Word& word : experiment.words) {
        const CellIdentity identity = identify(experiment, c, model, word);
        CellRecord& cell =
            cells.emplace_back(CellRecord{c.folder, word.text, "", {}, c.name, c.domain, model});
        cell.moments = identity.geometry;
        cell.variant = c.variant;
        cell.skipped = absent;
        cell.kind = absent           ? "data not found"
                    : folder.empty() ? "to do"
                                     : state_of_cell(cell_folder(folder, c, word), identity.key);
        if (absent) cell.reason = cell.kind;
        add_planned_values(experiment, c, word, static_cast<double>(cells.size()), cell);
      }
    }
  find_domains(cells);
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
    const int runs = cell.skipped ? 0 : experiment.repeat_times + (needs_no_run(cell) ? 0 : 1);
    auto at = known.find(cell.name + "/" + cell.pipeline);
    if (runs > 0 && at == known.end()) {
      at = known.find(cell.pipeline);
      ++(at == known.end() ? unknown : guessed);
    }
    if (at != known.end()) seconds += runs * mean(at->second);
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
  TestDesign(const Experiment& experiment, const std::vector<CellRecord>& cells)
      : study_(describe(experiment)), inference_(study_, cells) {}

  std::string text(std::optional<double> effect) const {
    const auto now = at_best(0);
    std::string text =
        is_planned()
            ? fmt::format("tests of hypotheses: {} primary, {} secondary\n", now[0].size(), now[1].size())
            : fmt::format(
                  "tests: at most {}, of which {} could prove something; {} are of pairs, over domains\n",
                  now[0].size(), now[0].counted(), over_domains().size());
    // Tests of the same power are told together.
    std::map<std::tuple<bool, bool, std::size_t>, std::vector<const PairComparison*>> alike;
    for (const PairComparison& pair : over_domains())
      alike[{pair.secondary, pair.one_sided, pair.domains.names.size()}].push_back(&pair);
    for (const auto& [kind, pairs] : alike) text += line(pairs, now, effect);
    return text;
  }

 private:
  using Families = std::array<ClaimFamily, 2>;  ///< primary and secondary

  bool is_planned() const { return !study_.hypotheses.empty(); }
  const std::vector<PairComparison>& over_domains() const {
    return is_planned() ? inference_.hypotheses() : inference_.pairs();
  }

  /// With `more` domains than there are.
  Families at_best(int more) const {
    Families families;
    for (const bool secondary : {false, true}) {
      if (secondary && !is_planned()) break;
      std::set<std::size_t> growing;
      for (const PairComparison& pair : over_domains())
        if (pair.secondary == secondary) growing.insert(pair.test);
      const ClaimFamily& family = is_planned() ? inference_.planned(secondary) : inference_.family();
      for (std::size_t i = 0; i < family.size(); ++i) {
        RankTest test = family.test(i);
        if (growing.contains(i)) test.least_p = std::ldexp(test.least_p, -more);
        test.p = test.least_p;
        families[secondary].add(test);
      }
      families[secondary].decide(secondary ? families[0].largest_p() : 0);
    }
    return families;
  }

  /// Of tests that have as many domains and sides.
  std::string line(const std::vector<const PairComparison*>& pairs, const Families& now,
                   std::optional<double> effect) const {
    const PairComparison& pair = *pairs[0];
    const std::size_t domains = pair.domains.names.size();
    const ClaimFamily& family = now[pair.secondary];
    const auto can_prove = [&](const Families& families) {
      return families[pair.secondary].finding(pair.test) == Finding::kProven;
    };
    std::string text = fmt::format("  {}{} {}-sided over {} domains: ", pair.secondary ? "secondary, " : "",
                                   pairs.size(), pair.one_sided ? "one" : "two", domains);
    if (!can_prove(now)) {
      int more = 1;
      while (!can_prove(at_best(more))) ++more;
      return text + fmt::format("nothing can be proven; it takes {} domains\n",
                                domains + static_cast<std::size_t>(more));
    }
    text += "p corrected " + p_text(family.adjusted_p(pair.test)) + " at the least";
    if (effect)
      text +=
          fmt::format("; power {:.2f} for {:g} deviations",
                      wilcoxon_power(domains, *effect, kSignificance / static_cast<double>(family.counted()),
                                     pair.one_sided),
                      *effect);
    return text + "\n";
  }

  StudyFile study_;
  Inference inference_;
};

}  // namespace

std::optional<double> expected_seconds(const Experiment& experiment, const fs::path& folder) {
  if (experiment.minutes == 0) return std::nullopt;
  constexpr double kMinute = 60;
  if (experiment.linf) return kMinute * experiment.minutes;
  const std::vector<CellRecord> cells = planned_cells(experiment, folder);
  const auto left = std::ranges::count_if(
      cells, [](const CellRecord& cell) { return !cell.skipped && !needs_no_run(cell); });
  return kMinute * experiment.minutes * static_cast<double>(left) / static_cast<double>(cells.size());
}

std::string list_cells(const Experiment& experiment, const fs::path& folder) {
  return text_of_cells(planned_cells(experiment, folder));
}

std::string dry_run(const Experiment& experiment, const fs::path& folder, std::optional<double> effect) {
  if (experiment.linf) return "";  // it has no cells
  experiment.check_hypotheses();
  const std::string refusal = why_folder_is_refused(experiment, folder);
  const std::vector<CellRecord> cells = planned_cells(experiment, refusal.empty() ? folder : "");
  const StudyFile study = describe(experiment);
  const bool is_late = !study.hypotheses.empty() && !folder.empty() && is_plan_changed(study, folder);
  const std::string warning = refusal.empty() && is_late ? kNotPlanned : refusal;
  return text_of_cells(cells) + (warning.empty() ? "" : "warning: " + warning + "\n") +
         fmt::format("cells: {}, of which {} are done\n", cells.size(),
                     std::ranges::count_if(cells, needs_no_run)) +
         time_text(experiment, cells, folder) + domains_text(cells) +
         TestDesign(experiment, cells).text(effect);
}

}  // namespace delquad
