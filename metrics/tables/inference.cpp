// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/inference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace delquad {

namespace {

/// Compares runs of pipelines that make quads. Measures of quads leave out pipelines that leave triangles.
class Comparing {
 public:
  explicit Comparing(const std::vector<CellRecord>& records) : records_(records) {
    for (const CellRecord& record : records) {
      if (leaves_triangles(record)) with_triangles_.insert(record.pipeline);
      if (record.reason.empty()) (makes_quads(record) ? with_quads_ : done_).insert(record.pipeline);
    }
  }

  PairComparison operator()(const std::string& along, const std::string& first, const std::string& second,
                            const Metric& metric) const {
    const std::string head = along.empty() ? "" : along + "=";
    PairComparison pair{
        head + first, head + second, metric,
        pair_by_domain(runs(along, first, metric.key), runs(along, second, metric.key), metric, along)};
    pair.interval = interval_of_mean(pair.domains.finite());
    return pair;
  }

 private:
  std::vector<const CellRecord*> runs(const std::string& along, const std::string& value,
                                      const std::string& key) const {
    const auto competes = [&](const std::string& pipeline) {
      return (with_quads_.contains(pipeline) || !done_.contains(pipeline)) &&
             !(is_of_quads(key) && with_triangles_.contains(pipeline));
    };
    std::vector<const CellRecord*> result;
    for (const CellRecord& record : records_)
      if (!record.skipped && value_along(record, along) == value && competes(record.pipeline))
        result.push_back(&record);
    return result;
  }

  const std::vector<CellRecord>& records_;
  std::set<std::string> with_triangles_, with_quads_, done_;
};

/// Texts for a first that is proven better, and for one that is proven worse.
using Words = std::array<const char*, 2>;

std::string in_words(const PairComparison& pair, const ClaimFamily& family, const Words& words) {
  if (family.is_exploratory()) return "exploratory";
  const std::vector<double>& all = pair.domains.differences;
  if (all.size() >= kFewestDomains && std::ranges::all_of(all, [](double d) { return d == 0; }))
    return "no difference";
  if (family.finding(pair.test) == Finding::kTooFew) return "too few domains";
  const auto better = first_is_better(pair, family);
  if (!better) return "not proven";
  const std::string failures = pair.failures();
  return words[*better ? 0 : 1] + (failures.empty() ? "" : " (" + failures + ")");
}

TableRow row_of(const PairComparison& pair, const ClaimFamily& family, const Words& words) {
  const PairedDomains& domains = pair.domains;
  const std::vector<double> finite = domains.finite();
  const double sign = pair.metric.better == Better::kHigher ? 1 : -1, effect = mean(finite);
  const auto count = [&](double side) {
    return static_cast<double>(
        std::ranges::count_if(domains.differences, [&](double d) { return side * sign * d > 0; }));
  };
  TableRow row{pair.first + " - " + pair.second, pair.metric.title, {}, {}, "", ""};
  row.values = {{"domains", static_cast<double>(domains.names.size())},
                {"runs", static_cast<double>(domains.runs)},
                {"better", count(1)},
                {"worse", count(-1)},
                {"first_failed", static_cast<double>(domains.failed[0])},
                {"second_failed", static_cast<double>(domains.failed[1])},
                {"effect", effect},
                {"p", family.test(pair.test).p},
                {"p_corrected", family.adjusted_p(pair.test)}};
  if (pair.interval) {
    row.values["low"] = pair.interval->low;
    row.values["high"] = pair.interval->high;
    row.texts["effect"] = interval_text(effect, *pair.interval, pair.metric.digits);
  }
  for (const char* key : {"p", "p_corrected"})
    if (!std::isnan(row.values[key])) row.texts[key] = p_text(row.values[key]);
  row.texts["first_is"] = in_words(pair, family, words);
  if (first_is_better(pair, family) && !domains.has_failures()) row.bold.insert("effect");
  return row;
}

Table comparison_table(const std::string& title, const char* heading, const char* verdict,
                       const std::vector<PairComparison>& pairs, const ClaimFamily& family,
                       const Words& words) {
  Table table{title, heading, "measure", {}, {}, {}};
  table.columns = {{"domains", "domains", 0},
                   {"runs", "runs", 0},
                   {"better", "better", 0},
                   {"worse", "worse", 0},
                   {"first_failed", "first failed", 0},
                   {"second_failed", "second failed", 0},
                   {"effect", "difference", 4},
                   {"low", "low", 4},
                   {"high", "high", 4},
                   {"p", "p", 4},
                   {"p_corrected", "p corrected", 4},
                   {"first_is", verdict, 0}};
  table.shown = {"domains", "runs", "better", "worse", "effect", "p", "p_corrected", "first_is"};
  if (std::ranges::any_of(pairs, [](const PairComparison& p) { return p.domains.has_failures(); }))
    table.shown.insert(table.shown.begin() + 4, {"first_failed", "second_failed"});
  table.notes = {
      "First minus second, averaged over the seeds and variants of each domain (geometry); domains are the "
      "sample. Better, worse: on how many of them the first is. A side that failed on a domain is worse "
      "there. Difference: the mean of the domains on which neither failed, with its 95 % interval."};
  std::vector<std::string> said;
  for (const PairComparison& pair : pairs) {
    table.rows.push_back(row_of(pair, family, words));
    if (pair.domains.left_out.empty()) continue;
    const std::string text = fmt::format("{} and {} both failed on {}: left out", pair.first, pair.second,
                                         fmt::join(pair.domains.left_out, ", "));
    if (std::ranges::find(said, text) == said.end()) said.push_back(text);
  }
  table.notes.insert(table.notes.end(), said.begin(), said.end());
  return table;
}

}  // namespace

std::string PairComparison::failures() const {
  std::string text;
  for (const auto& [name, count] : {std::pair(&first, domains.failed[0]), {&second, domains.failed[1]}})
    if (count > 0) text += fmt::format("{}{} failed on {}", text.empty() ? "" : ", ", *name, count);
  return text;
}

std::optional<bool> first_is_better(const PairComparison& pair, const ClaimFamily& family) {
  if (family.finding(pair.test) != Finding::kProven || !pair.interval) return std::nullopt;
  const bool is_larger = family.test(pair.test).lean > 0;
  if (is_larger ? pair.interval->low <= 0 : pair.interval->high >= 0) return std::nullopt;
  return is_larger == (pair.metric.better == Better::kHigher);
}

Table pairs_table(const std::string& title, const Inference& inference) {
  const std::vector<PairComparison>& pairs = inference.pairs();
  const ClaimFamily& family = inference.family();
  Table table = comparison_table(title + ": pairs of pipelines", "pipelines", "first is", pairs, family,
                                 {"better", "worse"});
  const auto has_few = [](const PairComparison& pair) { return pair.domains.names.size() < kFewestDomains; };
  const bool says_nothing = std::ranges::all_of(pairs, has_few) && !family.is_exploratory();
  table.notes.push_back("p: Wilcoxon's signed-rank test over the domains, two-sided." +
                        (says_nothing ? "" : " " + family.note()));
  if (std::ranges::any_of(pairs, has_few))
    table.notes.push_back(fmt::format("With fewer than {} domains nothing can be proven.", kFewestDomains));
  return table;
}

Table hypotheses_table(const std::string& title, const Inference& inference) {
  const ClaimFamily& family = inference.planned();
  Table table = comparison_table(title + ": hypotheses", "hypothesis", "verdict", inference.hypotheses(),
                                 family, {"proven", "refuted"});
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i].group =
        fmt::format("{} better than {}", inference.hypotheses()[i].first, inference.hypotheses()[i].second);
  table.notes.push_back("p: Wilcoxon's signed-rank test over the domains, two-sided. " +
                        family.note("of the hypotheses"));
  return table;
}

namespace {

constexpr const char* kSeconds = "seconds";
constexpr const char* kTauGiven = "tau_given";
constexpr int kTimeDigits = 2;
/// Columns of the paper's tables, with counts, and properties that eta cannot see.
const std::vector<std::pair<const char*, int>> kColumns = {
    {"n_vertices", 0}, {"n_quads", 0},     {"n_triangles", 0},   {"eta_worst", 3},
    {"eta_mean", 3},   {"d4", 1},          {"d_min", 0},         {"d_max", 0},
    {"tau", 1},        {kTauGiven, 1},     {"percent_quads", 1}, {"aspect_max", 1},
    {"edge_min", 3},   {"misalignment", 1}};
/// Stages that remove irregular vertices, and their columns.
constexpr const char* kRegularStages = "QKR";
const std::vector<const char*> kRegularity = {"n_irregular", "n_irregular_on_curves", "n_necessary",
                                              "n_beyond"};
/// Measures in which pairs of pipelines are compared, beside the study's own.
const std::vector<const char*> kCompared = {"eta_mean", "eta_worst", "d4", "tau"};

std::optional<Metric> metric_of(const std::string& key, const std::vector<Metric>& own) {
  if (const Metric* metric = find_metric(key)) return *metric;
  const auto at = std::ranges::find(own, key, &Metric::key);
  return at == own.end() ? std::nullopt : std::optional(*at);
}

void add_measure(const std::string& key, const std::vector<Metric>& own, std::vector<Metric>& measures) {
  const std::optional<Metric> metric = metric_of(key, own);
  const bool known = std::ranges::find(measures, key, &Metric::key) != measures.end();
  if (metric && metric->better != Better::kNeither && !known) measures.push_back(*metric);
}

std::vector<PairComparison> compare_pairs(const StudyFile& study, const std::vector<CellRecord>& records,
                                          ClaimFamily& family) {
  const Comparing compare(records);
  const std::vector<Metric> measures = compared_measures(study, records);
  std::vector<PairComparison> pairs;
  const auto add_all = [&](const std::string& along, const std::vector<std::string>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (const Metric& metric : measures) {
          PairComparison pair = compare(along, values[i], values[j], metric);
          if (pair.domains.names.size() < 2) continue;
          pair.test = family.add(wilcoxon(pair.domains.differences));
          pairs.push_back(std::move(pair));
        }
  };
  add_all("", study.pipelines);
  for (const auto& [title, values] : study.axes)
    if (std::ranges::find(study.pairs, title) != study.pairs.end()) add_all(title, values);
  return pairs;
}

std::vector<PairComparison> compare_hypotheses(const StudyFile& study, const std::vector<CellRecord>& records,
                                               ClaimFamily& family) {
  const std::vector<Metric> own = added_metrics_of(records);
  const Comparing compare(records);
  std::vector<PairComparison> all;
  for (const Hypothesis& h : study.hypotheses)
    for (const std::string& key : h.measures) {
      // A measure that no record has cannot be compared.
      const Metric metric = metric_of(key, own).value_or(Metric{key, key, "", Better::kHigher, 0, ""});
      all.push_back(compare(h.along, h.better, h.than, metric));
      all.back().test = family.add(wilcoxon(all.back().domains.differences));
    }
  return all;
}

}  // namespace

std::vector<Metric> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records) {
  const std::vector<Metric> own = added_metrics_of(records);
  std::vector<Metric> measures;
  for (const char* key : kCompared) add_measure(key, own, measures);
  for (const Metric& metric : own) add_measure(metric.key, own, measures);
  for (const std::string& key : study.columns) add_measure(key, own, measures);
  return measures;
}

Interval range_of(const std::string& key) {
  if (key.starts_with("eta_")) return {0, 1};
  if (key.starts_with("scaled_jacobian_")) return {-1, 1};
  static const std::vector<std::string> percentages = {"d4", "tau", kTauGiven, "percent_quads"};
  if (std::ranges::find(percentages, key) != percentages.end()) return {0, 100};
  if (key.starts_with("aspect_")) return {1, HUGE_VAL};
  if (key.starts_with("n_") || key.starts_with("seconds") || key == "edge_min" || key == kFinishSeconds)
    return {0, HUGE_VAL};
  return TableColumn().range;
}

std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records) {
  const bool adapted =
      std::ranges::any_of(records, [](const CellRecord& record) { return !record.size_adapted_to.empty(); });
  const std::vector<Metric> own = added_metrics_of(records);
  std::vector<TableColumn> columns = {{kRuns, "n", 0}};
  for (const auto& [key, digits] : kColumns) {
    const Metric* metric = find_metric(key);
    if (key == std::string(kTauGiven) && !adapted) continue;
    columns.push_back({key, metric == nullptr ? key : metric->title, digits});
  }
  if (std::ranges::any_of(records, [](const CellRecord& record) {
        return record.pipeline.find_first_of(kRegularStages) != std::string::npos;
      }))
    for (const char* key : kRegularity) columns.push_back({key, find_metric(key)->title, 0});
  for (const Metric& metric : own) columns.push_back({metric.key, metric.title, metric.digits});
  if (study.step_times) {
    for (const StepTime& step : step_times_of_tables())
      columns.push_back({step.key, step.title, kTimeDigits});
    columns.push_back({kFinishSeconds, "finish s", kTimeDigits});
  } else {
    columns.push_back({kSeconds, "s", kTimeDigits});
  }
  for (const std::string& key : study.columns) {
    if (std::ranges::find(columns, key, &TableColumn::key) != columns.end()) continue;
    for (const Metric& metric : columns_of_records())
      if (key == metric.key) columns.push_back({key, metric.title, metric.digits});
    if (const auto metric = metric_of(key, own)) columns.push_back({key, metric->title, metric->digits});
  }
  for (TableColumn& column : columns)
    if (std::ranges::find(own, column.key, &Metric::key) == own.end()) column.range = range_of(column.key);
  return columns;
}

Inference::Inference(const StudyFile& study, const std::vector<CellRecord>& records)
    : pairs_(compare_pairs(study, records, family_)),
      hypotheses_(compare_hypotheses(study, records, planned_)) {
  study.hypotheses.empty() && !study.plan_changed ? family_.decide() : family_.explore();
  study.plan_changed ? planned_.explore() : planned_.decide();
}

std::optional<bool> Inference::first_is_better(const PairComparison& pair) const {
  if (!family_.is_exploratory()) return delquad::first_is_better(pair, family_);
  for (const PairComparison& planned : hypotheses_) {
    const bool is_same = planned.first == pair.first && planned.second == pair.second;
    if (planned.metric.key != pair.metric.key ||
        !(is_same || (planned.first == pair.second && planned.second == pair.first)))
      continue;
    if (const auto better = delquad::first_is_better(planned, planned_)) return *better == is_same;
  }
  return std::nullopt;
}

}  // namespace delquad
