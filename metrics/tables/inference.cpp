#include "metrics/tables/inference.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "metrics/metrics.h"

namespace delquad {
namespace {

constexpr const char* kSeconds = "seconds";
constexpr const char* kSecondsTotal = "seconds_total";
constexpr const char* kTauGiven = "tau_given";
constexpr int kTimeDigits = 2;
/// What the paper's tables show, with the counts, and what eta cannot see.
const std::vector<std::pair<const char*, int>> kColumns = {
    {"n_vertices", 0}, {"n_quads", 0}, {"n_triangles", 0},   {"eta_worst", 3},
    {"eta_mean", 3},   {"d4", 1},      {"d_min", 0},         {"d_max", 0},
    {"tau", 1},        {kTauGiven, 1}, {"percent_quads", 1}, {"aspect_max", 1},
    {"edge_min", 3}};
/// What pairs of pipelines are compared by, beside measures of the study's own.
const std::vector<const char*> kCompared = {"eta_mean", "eta_worst", "d4", "tau"};

std::optional<Metric> metric_of(const std::string& key, const std::vector<Metric>& own) {
  if (const Metric* metric = find_metric(key)) return *metric;
  const auto at = std::ranges::find(own, key, &Metric::key);
  return at == own.end() ? std::nullopt : std::optional(*at);
}

void add_measure(const std::string& key, const std::vector<Metric>& own,
                 std::vector<TestedMeasure>& measures) {
  const std::optional<Metric> metric = metric_of(key, own);
  const bool known = std::ranges::any_of(measures, [&](const auto& m) { return m.metric.key == key; });
  if (metric && metric->better != Better::kNeither && !known) measures.push_back({*metric});
}

/// Only where runs were repeated is there anything to say of times.
void add_time(const StudyFile& study, std::vector<TestedMeasure>& measures) {
  if (study.repeat_times < 2) return;
  const char* key = time_key(study);
  measures.push_back(
      {{key, "s", "s", Better::kLower, std::nan(""), "", kTimeDigits}, ValueKind::kRepeatedTime});
}

std::vector<TestedMeasure> marked_measures(const StudyFile& study, const std::vector<CellRecord>& records) {
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TestedMeasure> measures;
  for (const TableColumn& column : table_columns(study, records)) add_measure(column.key, own, measures);
  add_time(study, measures);
  return measures;
}

std::vector<TestedMeasure> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records) {
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TestedMeasure> measures;
  for (const char* key : kCompared) add_measure(key, own, measures);
  for (const Metric& metric : own) add_measure(metric.key, own, measures);
  for (const std::string& key : study.columns) add_measure(key, own, measures);
  add_time(study, measures);
  return measures;
}

/// What no value of a measure of the project's own can leave.
Interval range_of(const std::string& key) {
  if (key.starts_with("eta_")) return {0, 1};
  if (key.starts_with("scaled_jacobian_")) return {-1, 1};
  static const std::vector<std::string> percentages = {"d4", "tau", kTauGiven, "percent_quads"};
  if (std::ranges::find(percentages, key) != percentages.end()) return {0, 100};
  return TableColumn().range;
}

void add_times(const StudyFile& study, std::vector<TableColumn>& columns) {
  const bool repeated = study.repeat_times > 0;
  if (study.step_times) {
    for (const StepTime& step : step_times_of_tables())
      columns.push_back({step.key, step.title, kTimeDigits});
    columns.push_back({kFinishSeconds, "finish s", kTimeDigits});
  } else
    columns.push_back({kSeconds, repeated ? "s, median" : "s", kTimeDigits});
  if (repeated)
    columns.push_back({kLeastTime, study.step_times ? "total s, least" : "s, least", kTimeDigits});
}

}  // namespace

const char* time_key(const StudyFile& study) { return study.step_times ? kSecondsTotal : kSeconds; }

std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records) {
  const bool adapted =
      std::ranges::any_of(records, [](const CellRecord& record) { return !record.size_adapted_to.empty(); });
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TableColumn> columns = {{kRuns, "n", 0}};
  for (const auto& [key, digits] : kColumns) {
    const Metric* metric = find_metric(key);
    if (key == std::string(kTauGiven) && !adapted) continue;
    columns.push_back({key, metric == nullptr ? key : metric->title, digits});
  }
  for (const Metric& metric : own) columns.push_back({metric.key, metric.title, metric.digits});
  add_times(study, columns);
  for (const std::string& key : study.columns) {
    if (std::ranges::find(columns, key, &TableColumn::key) != columns.end()) continue;
    if (key == kSeconds) columns.push_back({key, "s", kTimeDigits});
    for (const TableColumn& column : columns_of_records())
      if (key == column.key) columns.push_back(column);
    if (const auto metric = metric_of(key, own)) columns.push_back({key, metric->title, metric->digits});
    for (const StepTime& step : step_times_of_tables())
      if (key == step.key) columns.push_back({key, step.title, kTimeDigits});
  }
  for (TableColumn& column : columns)
    if (find_metric(column.key) != nullptr) column.range = range_of(column.key);
  return columns;
}

Inference::Inference(const StudyFile& study, const std::vector<CellRecord>& records)
    : samples_(group_samples(records)),
      marking_(samples_, marked_measures(study, records), family_),
      pairs_(compare_pairs(records, study.pipelines, compared_measures(study, records), family_)) {
  family_.decide();
}

}  // namespace delquad
