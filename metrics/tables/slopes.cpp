#include "metrics/tables/slopes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "metrics/tables/samples.h"

namespace delquad {
namespace {

constexpr const char* kAllCases = "all cases";
constexpr int kPlainDigits = 6;  // of measures that have none

/// Runs that differ by seed and along the axis alone.
struct Series {
  std::string group, name;
  std::vector<std::pair<std::string, std::vector<const CellRecord*>>> steps;  ///< along the axis
};

std::vector<Series> series_of(const std::vector<CellRecord>& records, const std::string& along) {
  std::vector<Series> all;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    std::string name = record.pipeline, step;
    for (const auto& [title, value] : record.variant)
      if (title == along)
        step = value;
      else if (title != kSeedAxis)
        name += fmt::format(", {}={}", title, value);
    if (step.empty()) continue;
    auto at =
        std::ranges::find_if(all, [&](const Series& s) { return s.group == record.name && s.name == name; });
    if (at == all.end()) at = all.insert(all.end(), {record.name, name, {}});
    auto where =
        std::ranges::find(at->steps, step, &std::pair<std::string, std::vector<const CellRecord*>>::first);
    if (where == at->steps.end()) where = at->steps.insert(at->steps.end(), {step, {}});
    where->second.push_back(&record);
  }
  return all;
}

struct Points {
  std::vector<double> x, y;
};

/// Both above 0.
Points points_of(const std::vector<const CellRecord*>& runs, const std::string& against,
                 const std::string& key) {
  Points points;
  for (const CellRecord* run : runs) {
    const double x = value_of(*run, against), y = value_of(*run, key);
    if (!(x > 0 && y > 0)) continue;
    points.x.push_back(x);
    points.y.push_back(y);
  }
  return points;
}

double log_mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += std::log(v);
  return values.empty() ? std::nan("") : std::exp(sum / static_cast<double>(values.size()));
}

void add_measure(const Series& series, const std::string& key, const SlopeRequest& request, double middle,
                 TableRow& row) {
  Points all;
  double before = HUGE_VAL;
  int rises = 0;
  for (const auto& [step, runs] : series.steps) {
    const Points points = points_of(runs, request.against, key);
    all.x.insert(all.x.end(), points.x.begin(), points.x.end());
    all.y.insert(all.y.end(), points.y.begin(), points.y.end());
    const double now = log_mean(points.y);
    rises += now >= before ? 1 : 0;
    if (!std::isnan(now)) before = now;
  }
  const auto law = fit_power_law(all.x, all.y);
  if (!law) return;
  row.values["slope." + key] = law->exponent;
  row.half_widths["slope." + key] = law->half_width;
  row.values["at." + key] = law->factor * std::pow(middle, law->exponent);
  row.values["rises." + key] = rises;
}

/// Of rows with the same name.
std::vector<TableRow> mean_rows(const std::vector<TableRow>& rows, const std::vector<std::string>& keys) {
  std::vector<TableRow> means;
  for (const TableRow& row : rows) {
    if (std::ranges::find(means, row.name, &TableRow::name) != means.end()) continue;
    TableRow& all = means.emplace_back(TableRow{kAllCases, row.name, {}, {}, "", ""});
    for (const std::string& key : keys) {
      std::vector<double> slopes;
      for (const TableRow& other : rows)
        if (const double s = value_or_nan(other.values, "slope." + key);
            other.name == row.name && !std::isnan(s))
          slopes.push_back(s);
      if (slopes.empty()) continue;
      all.values["slope." + key] = mean(slopes);
      all.half_widths["slope." + key] = confidence_half_width(slopes);
    }
  }
  return means;
}

}  // namespace

Table slope_table(const std::string& title, const SlopeRequest& request,
                  const std::vector<CellRecord>& records) {
  Table table;
  table.title = title + ": powers";
  std::vector<Metric> metrics = own_metrics_of(records);
  metrics.insert(metrics.end(), metric_registry().begin(), metric_registry().end());
  for (const std::string& key : request.of) {
    const auto at = std::ranges::find(metrics, key, &Metric::key);
    const std::string name = at == metrics.end() ? key : at->title;
    table.columns.push_back({"slope." + key, name + ": power", 2});
    table.columns.push_back({"at." + key, "at the middle", at == metrics.end() ? kPlainDigits : at->digits});
    table.columns.push_back({"rises." + key, "rises", 0});
  }
  const std::vector<Series> all = series_of(records, request.along);
  std::map<std::string, std::vector<double>> abscissas;  // by case
  for (const Series& series : all)
    for (const auto& [step, runs] : series.steps)
      for (const CellRecord* run : runs)
        if (const double x = value_of(*run, request.against); x > 0) abscissas[series.group].push_back(x);
  std::vector<TableRow> rows;
  for (const Series& series : all) {
    TableRow row{series.group, series.name, {}, {}, "", ""};
    for (const std::string& key : request.of)
      add_measure(series, key, request, log_mean(abscissas[series.group]), row);
    if (!row.values.empty()) rows.push_back(std::move(row));
  }
  table.rows = rows;
  for (TableRow& row : mean_rows(rows, request.of)) table.rows.push_back(std::move(row));
  table.notes.push_back(fmt::format(
      "Power: of {} that the measure goes with as {} varies, by least squares of the logarithms over all "
      "runs, with half "
      "of its 95 % interval by Student's t (of all cases: over cases). At the middle: by that law, where {} "
      "is the "
      "geometric mean of all runs of the case. Rises: steps at which the mean over seeds does not fall.",
      request.against, request.along, request.against));
  return table;
}

}  // namespace delquad
